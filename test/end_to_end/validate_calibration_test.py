"""A calibration holds on the half of a recording that it was not made from; a moved camera is found."""

import csv
import shutil
import unittest

import yaml

from programs import Recordings, assert_stopped, calibrate, interrupt_after, run, start

TOPICS = ["/cam0/image_raw", "/cam1/image_raw"]
FIRST_HALF, SECOND_HALF = ["--bag-from-to", 0, 2.9], ["--bag-from-to", 3, 100]


class ValidateCalibration(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.recordings = Recordings()
        cls.addClassCleanup(cls.recordings.remove)
        cls.folder = cls.recordings.path
        cls.bag = cls.recordings.simulate("rig", "--cameras", 2, "--resolution", "640x512", "--views", 24, "--yaw", 8)
        cls.target = cls.recordings.target("rig")
        finished = calibrate(cls.bag, cls.target, ["ds-none", "ds-none"], extra=FIRST_HALF)
        assert finished.returncode == 0, finished.stderr
        cls.camchain = cls.folder / "rig-camchain.yaml"

    def validate(self, *flags, bag=None, camchain=None, target=None):
        return run("validate_calibration", "--bag", bag or self.bag, "--camchain", camchain or self.camchain, "--target",
                   target or self.target, *flags)

    def assert_refused(self, finished, code, *parts):
        self.assertEqual(finished.returncode, code, finished.stdout)
        self.assertEqual(len(finished.stderr.splitlines()), 1, finished.stderr)
        for part in ("[ERROR]", *parts):
            self.assertIn(part, finished.stderr)

    def changed(self, name, change):
        """The camchain with a change, beside a copy of its results file."""
        chain = yaml.safe_load(self.camchain.read_text())
        change(chain)
        path = self.folder / f"{name}-camchain.yaml"
        path.write_text(yaml.safe_dump(chain, default_flow_style=None))
        shutil.copy(self.folder / "rig-results-cam.txt", self.folder / f"{name}-results-cam.txt")
        return path

    def test_the_other_half_of_the_recording_agrees(self):
        picture, errors = self.folder / "errors.png", self.folder / "errors.csv"
        finished = self.validate(*SECOND_HALF, "--output", picture, "--export", errors)
        self.assertEqual(finished.returncode, 0, finished.stderr)
        self.assertIn("Verdict: the calibration holds", finished.stdout)
        self.assertEqual(picture.read_bytes()[:8], b"\x89PNG\r\n\x1a\n")
        with errors.open() as file:
            rows = list(csv.DictReader(file))
        self.assertEqual({row["camera"] for row in rows}, {"0", "1"})
        self.assertGreater(len(rows), 1000)

    def test_a_camera_that_was_moved_is_found_and_its_lens_is_not_blamed(self):
        def move(chain):
            chain["cam1"]["T_cn_cnm1"][1][3] += 0.005
        finished = self.validate(*SECOND_HALF, camchain=self.changed("moved", move))
        self.assertEqual(finished.returncode, 0, finished.stderr)
        self.assertIn("Verdict: the calibration does not hold", finished.stdout)
        self.assertIn("place on the rig", finished.stdout)
        alone = [line.split() for line in finished.stdout.splitlines() if "this camera alone" in line]
        self.assertEqual(len(alone), 2)
        for words in alone:
            self.assertLess(float(words[4]), 0.05)

    def test_corners_and_images_give_the_same_errors(self):
        corners = self.folder / "alone.csv"
        finished = run("detect_corners", "--bag", self.bag, "--target", self.target, "--topics", *TOPICS, "--output", corners)
        self.assertEqual(finished.returncode, 0, finished.stderr)
        from_images = self.validate().stdout.splitlines()
        finished = run("validate_calibration", "--corners", corners, "--camchain", self.camchain, "--target", self.target)
        self.assertEqual(finished.returncode, 0, finished.stderr)
        wanted = [line for line in from_images if "one pose for the rig" in line]
        self.assertEqual(len(wanted), 2)
        for line in wanted:
            self.assertIn(line, finished.stdout.splitlines())

    def test_bad_input_is_one_line(self):
        nowhere = self.folder / "nowhere"
        self.assert_refused(self.validate(bag=nowhere / "x.bag"), 1, "nowhere")
        self.assert_refused(self.validate(camchain=nowhere / "x.yaml"), 1, "x.yaml")
        self.assert_refused(self.validate(target=nowhere / "x.yaml"), 1, "x.yaml")
        self.assert_refused(self.validate("--output", nowhere / "x.png"), 1, "nowhere")
        self.assert_refused(self.validate("--export", nowhere / "x.csv"), 1, "nowhere")
        self.assert_refused(self.validate("--topics", "/cam0/image_raw"), 2, "one topic per camera")
        self.assert_refused(self.validate("--topics", "/cam0/image_raw", "/cam7/image_raw"), 1, "/cam7/image_raw")

        def shrink(chain):
            chain["cam0"]["resolution"] = [320, 256]
        self.assert_refused(self.validate(camchain=self.changed("small", shrink)), 1, "cam0", "640x512", "320x256")

    def test_ctrl_c_ends_it_without_files(self):
        before = set(self.folder.iterdir())
        process = start("validate_calibration", "--bag", self.bag, "--camchain", self.camchain, "--target", self.target, "--output",
                        self.folder / "stopped.png")
        stopped = interrupt_after("Looking for the board", process)
        assert_stopped(self, stopped, "of 24 images of /cam0/image_raw; nothing was written")
        self.assertEqual(set(self.folder.iterdir()), before)


if __name__ == "__main__":
    unittest.main()
