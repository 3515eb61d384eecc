"""Boards that create_target makes are boards for the other programs, and bad requests are answered in one line."""

import tempfile
import unittest
from pathlib import Path

from programs import run


class CreateTarget(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="tartan_calib_")
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def files(self):
        return sorted(file.name for file in self.folder.iterdir())

    def test_the_example_of_the_help_fits_on_a4(self):
        finished = run("create_target", self.folder / "board", *"--type apriltag --nx 6 --ny 6 --tsize 0.023 --tspace 0.3".split())
        self.assertEqual((finished.returncode, finished.stderr), (0, ""))
        self.assertIn("A4, 210.0 x 297.0 mm", finished.stdout)
        self.assertEqual(self.files(), ["board.pdf", "board.yaml"])

    def test_its_file_describes_the_board_to_other_programs(self):
        made = run("create_target", self.folder / "board", "--nx", 5, "--ny", 4, "--tsize", 0.05, "--first-id", 30, "--dpi", 60)
        self.assertEqual(made.returncode, 0, made.stderr)
        target = self.folder / "board.yaml"
        rendered = run("simulate", "--output-bag", self.folder / "run.bag", "--target", target, "--views", 2, "--resolution",
                       "320x240", "--lens", "pinhole70")
        self.assertEqual(rendered.returncode, 0, rendered.stderr)
        again = run("create_target", self.folder / "again", "--target", target, "--dpi", 60)
        self.assertEqual(again.returncode, 0, again.stderr)
        for extension in ("pdf", "png", "yaml"):
            self.assertEqual((self.folder / f"again.{extension}").read_bytes(), (self.folder / f"board.{extension}").read_bytes())

    def test_a_board_too_large_for_the_page_is_one_line_with_the_sizes(self):
        finished = run("create_target", self.folder / "board", "--page", "A4")
        self.assertEqual(finished.returncode, 1)
        self.assertRegex(finished.stderr, r"^\[ERROR\][^\n]*648\.0 x 752\.0 mm[^\n]*210\.0 x 297\.0 mm[^\n]*\n$")
        self.assertEqual(self.files(), [])

    def test_flags_that_make_no_sense_are_one_line(self):
        for flags, word in ((["--page", "A9"], "A9"), (["--type", "square"], "square"), (["--csx", "0.1"], "checkerboard"),
                            (["--tsize", "-1"], "tsize"), (["--nx", "2"], "--nx")):
            finished = run("create_target", self.folder / "board", *flags)
            self.assertEqual(finished.returncode, 2, finished.stderr)
            self.assertRegex(finished.stderr, r"^\[ERROR\][^\n]*\n$")
            self.assertIn(word, finished.stderr)
        self.assertEqual(self.files(), [])


if __name__ == "__main__":
    unittest.main()
