"""Ctrl-C while a recording is written: the program ends within a second, says how far it came, and leaves nothing."""

import unittest

from programs import Recordings, assert_stopped, interrupt_when, run, shows_bar, start_on_terminal

MANY = 3000  # views: more than are rendered or copied before the bar is seen


class InterruptedRecording(unittest.TestCase):
    def setUp(self):
        self.recordings = Recordings()
        self.addCleanup(self.recordings.remove)
        self.folder = self.recordings.path

    def stopped(self, partial, program, *arguments):
        """What became of the program, interrupted while there was a file or folder `partial`."""
        process, terminal = start_on_terminal(self, program, *arguments)

        def is_time():
            return shows_bar(terminal) and list(self.folder.glob(partial))
        return interrupt_when(is_time, process)

    def files(self):
        return {file.name for file in self.folder.iterdir()}

    def test_simulate_leaves_no_bag(self):
        views = ["--resolution", "320x256", "--views", MANY]
        stopped = self.stopped("x.bag.partial", "simulate", "--output-bag", self.folder / "x.bag", *views)
        assert_stopped(self, stopped, f"of {MANY} views; nothing was written")
        self.assertEqual(self.files(), set())

    def test_simulate_leaves_no_folder(self):
        views = ["--resolution", "320x256", "--views", MANY]
        stopped = self.stopped("x.partial-*/cam0", "simulate", "--output-dir", self.folder / "x", *views)
        assert_stopped(self, stopped, f"of {MANY} views; nothing was written")
        self.assertEqual(self.files(), set())

    def test_make_bag_leaves_no_bag(self):
        images = self.folder / "images"
        rendered = run("simulate", "--output-dir", images, "--resolution", "320x256", "--views", 1)
        self.assertEqual(rendered.returncode, 0, rendered.stderr)
        image = next((images / "cam0").iterdir())
        for index in range(1, MANY):
            (image.parent / f"{int(image.stem) + index}.png").symlink_to(image)
        before = self.files()
        stopped = self.stopped("x.bag.partial", "make_bag", "--folder", images, "--output-bag", self.folder / "x.bag")
        assert_stopped(self, stopped, f"of {MANY} images; nothing was written")
        self.assertEqual(self.files(), before)


if __name__ == "__main__":
    unittest.main()
