"""Corners detected alone are those that a calibration detects; nothing is left behind where there is no result."""

import csv
import math
import unittest

import yaml

from programs import Recordings, assert_stopped, calibrate, interrupt_after, interrupt_when, run, start

TOPICS = ["/cam0/image_raw", "/cam1/image_raw"]
MODELS = ["ds-none", "ds-none"]
# The file has pixels to 1e-6. Of this small recording that moves the focal length by 1e-5 px, a millionth of its stdev.
MAX_RATIO = 1e-6


def positions(file):
    """Pixel by (stamp, corner) of a file of corners."""
    with file.open() as lines:
        rows = list(csv.DictReader(line for line in lines if not line.startswith("#")))
    return {(row["stamp_ns"], row["corner_id"]): (float(row["u_px"]), float(row["v_px"])) for row in rows}


class DetectCorners(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.recordings = Recordings()
        cls.addClassCleanup(cls.recordings.remove)
        cls.bag = cls.recordings.simulate("rig", "--cameras", 2, "--resolution", "640x512", "--views", 24, "--yaw", 8)
        cls.target = cls.recordings.target("rig")

    def detect(self, *flags, topics=TOPICS, bag=None, target=None):
        return run("detect_corners", "--bag", bag or self.bag, "--target", target or self.target, "--topics", *topics, *flags)

    def start(self, output, *flags):
        return start("detect_corners", "--bag", self.bag, "--target", self.target, "--topics", *TOPICS, "--output",
                     self.recordings.path / output, *flags)

    def assert_refused(self, finished, code, *parts):
        self.assertEqual(finished.returncode, code, finished.stdout)
        self.assertEqual(len(finished.stderr.splitlines()), 1, finished.stderr)
        for part in ("[ERROR]", *parts):
            self.assertIn(part, finished.stderr)

    def test_a_calibration_from_its_corners_is_that_of_the_bag_without_rounds(self):
        corners = self.recordings.path / "alone-corners.csv"
        finished = self.detect("--output", corners)
        self.assertEqual(finished.returncode, 0, finished.stderr)
        self.assertIn("24, 24 with board (100.0 %)", finished.stdout)
        finished = run("calibrate_cameras", "--corners", corners, "--target", self.target, "--models", *MODELS, "--no-report")
        self.assertEqual(finished.returncode, 0, finished.stderr)
        finished = calibrate(self.bag, self.target, MODELS, extra=["--max-rounds", "0"])
        self.assertEqual(finished.returncode, 0, finished.stderr)
        alone, direct = (yaml.safe_load((self.recordings.path / f"{name}-camchain.yaml").read_text()) for name in ("alone", "rig"))
        for name, camera in direct.items():
            for value, other in zip(camera["intrinsics"], alone[name]["intrinsics"]):
                self.assertAlmostEqual(value, other, delta=MAX_RATIO * abs(value))
        for row, other_row in zip(direct["cam1"]["T_cn_cnm1"], alone["cam1"]["T_cn_cnm1"]):
            for value, other in zip(row, other_row):
                self.assertAlmostEqual(value, other, delta=MAX_RATIO)

    def test_letters_on_a_wall_are_no_checkerboard(self):
        # The room's posters have letters whose corners link to lattices of the board's size, beside the board and without it.
        target = self.recordings.path / "checkers.yaml"
        target.write_text("target_type: checkerboard\ntargetCols: 6\ntargetRows: 5\nrowSpacingMeters: 0.08\ncolSpacingMeters: 0.08\n")
        bag = self.recordings.simulate("posters", "--lens", "gopro150", "--target", target, "--views", 40, "--seed", 2)
        corners = self.recordings.path / "posters-corners.csv"
        finished = self.detect("--output", corners, topics=TOPICS[:1], bag=bag, target=target)
        self.assertEqual(finished.returncode, 0, finished.stderr)
        truth, found = (positions(file) for file in (self.recordings.path / "posters-truth-corners.csv", corners))
        self.assertGreaterEqual(len({stamp for stamp, _ in found}), 20)
        for corner, px in found.items():
            self.assertIn(corner, truth)
            self.assertLess(math.dist(px, truth[corner]), 1.0, corner)

    def test_the_same_bytes_whatever_the_threads(self):
        files = [self.recordings.path / f"threads{count}.csv" for count in (1, 3)]
        for count, file in zip((1, 3), files):
            self.assertEqual(self.detect("--threads", count, "--output", file).returncode, 0)
        self.assertEqual(*[file.read_bytes() for file in files])

    def test_pictures_are_bounded_and_show_every_topic(self):
        folder = self.recordings.path / "pictures"
        finished = self.detect("--pictures", folder, "--max-pictures", 6)
        self.assertEqual(finished.returncode, 0, finished.stderr)
        for camera in ("cam0", "cam1"):
            self.assertEqual(len(list((folder / camera).glob("*.png"))), 3)

    def test_bad_input_is_one_line(self):
        nowhere = self.recordings.path / "nowhere"
        self.assert_refused(self.detect(bag=nowhere / "x.bag", ), 1, "nowhere")
        self.assert_refused(self.detect(target=nowhere / "x.yaml"), 1, "x.yaml")
        self.assert_refused(self.detect(topics=["/cam7/image_raw"]), 1, "/cam7/image_raw")
        self.assert_refused(self.detect("--output", nowhere / "x.csv"), 1, "nowhere")
        self.assert_refused(self.detect("--bag-from-to", "3"), 2, "--bag-from-to")

    def test_no_board_is_no_result(self):
        board = self.recordings.path / "circles.yaml"
        board.write_text("target_type: circlegrid\ntargetCols: 4\ntargetRows: 11\nspacingMeters: 0.02\nasymmetricGrid: true\n")
        output = self.recordings.path / "none.csv"
        self.assert_refused(self.detect("--output", output, target=board), 1, "/cam0/image_raw", "/cam1/image_raw", "24 images")
        self.assertFalse(output.exists())

    def test_ctrl_c_ends_it_without_files(self):
        before = set(self.recordings.path.iterdir())
        stopped = interrupt_after("Looking for the board", self.start("stopped.csv"))
        assert_stopped(self, stopped, "of 24 images of /cam0/image_raw; nothing was written")
        self.assertEqual(set(self.recordings.path.iterdir()), before)

    def test_ctrl_c_while_it_draws_keeps_corners_and_whole_pictures(self):
        folder = self.recordings.path / "some"
        stopped = interrupt_when(lambda: len(list(folder.glob("*/*.png"))) > 2, self.start("kept.csv", "--pictures", folder))
        corners = self.recordings.path / "kept.csv"
        assert_stopped(self, stopped, f"of 24 pictures of cam0; {corners} and the pictures so far are written")
        self.assertEqual({file.suffix for file in folder.glob("*/*")}, {".png"})
        self.assertTrue(corners.exists())


if __name__ == "__main__":
    unittest.main()
