"""TartanCalib's command line: its flags, its files, its pictures, and the views that find more corners."""

import csv
import math
import unittest

import yaml

from programs import Recordings, calibrate, run

FALSE_PX = 2.0


def corners_in(file):
    """(camera, stamp, id) to (u, v, used)."""
    lines = [line for line in file.read_text().splitlines() if not line.startswith(("#", "camera"))]
    return {tuple(row[:3]): (float(row[3]), float(row[4]), row[8] == "1") for row in csv.reader(lines)}


class WideRecording(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.recordings = Recordings()
        cls.addClassCleanup(cls.recordings.remove)
        cls.folder = cls.recordings.path
        cls.bag = cls.recordings.simulate("wide", "--resolution", "640x512", "--views", 16, "--hands", 0.5)
        cls.target = cls.recordings.target("wide")
        cls.truth = corners_in(cls.folder / "wide-truth-corners.csv")

    def tartan_calibrate(self, save_dir, *flags):
        return run("tartan_calibrate", "--bag", self.bag, "--target", self.target, "--topics", "/cam0/image_raw", "--models",
                   "ds-none", "--save_dir", save_dir, "--no-report", *flags)

    def score(self, file):
        """(found, false) of the corners of a file against the truth."""
        distances = {key: math.dist(corner[:2], self.truth[key][:2]) if key in self.truth else math.inf
                     for key, corner in corners_in(file).items()}
        found = sum(distance <= FALSE_PX and self.truth[key][2] for key, distance in distances.items())
        return found, sum(distance > FALSE_PX for distance in distances.values())


class Views(WideRecording):
    def test_each_kind_of_view_finds_more_and_nothing_false(self):
        found, false = {}, {}
        for name, flags in {"none": [], "cube": ["--projections", "cube"], "homography": ["--projections", "homography"],
                            "pinhole": ["--projections", "pinhole", "--fovs", 120, "--fovs", 120, "--poses", 0, "--poses", 0,
                                        "--resolutions", 1200, "--resolutions", 1200]}.items():
            finished = calibrate(self.bag, self.target, ["ds-none"],
                                 extra=["--max-rounds", 0, "--export-corners", *flags])
            self.assertEqual(finished.returncode, 0, finished.stderr)
            found[name], false[name] = self.score(self.folder / "wide-corners.csv")
            self.assertLessEqual(false[name], false["none"], name)
        self.assertGreater(found["cube"], found["none"])
        self.assertGreater(found["homography"], found["none"])
        self.assertGreaterEqual(found["pinhole"], found["none"])


class TartanCalibrate(WideRecording):
    def test_files_have_the_names_of_tartancalib(self):
        folder = self.folder / "made" / "for_it"
        finished = self.tartan_calibrate(folder, "--log_dest", "rig", "--export-corners")
        self.assertEqual(finished.returncode, 0, finished.stderr)
        for name in ("rig0-camchain.yaml", "rig0-results-cam.txt", "rig1-camchain.yaml", "rig1-results-cam.txt"):
            self.assertTrue((folder / name).exists(), name)
        self.assertEqual(list(self.folder.glob("wide-camchain.yaml")), [])
        first, last = (yaml.safe_load((folder / f"rig{i}-camchain.yaml").read_text())["cam0"] for i in (0, 1))
        self.assertEqual(first["resolution"], last["resolution"])
        self.assertNotEqual(first["intrinsics"], last["intrinsics"])
        self.assertIn("Started tartan calib with ", finished.stdout)
        self.assertIn("Ended tartan calib with ", finished.stdout)

    def test_flags_without_effect_say_why(self):
        finished = self.tartan_calibrate(self.folder / "noted", "--force_all", "--polar_setting", 1, "--max-rounds", 0)
        self.assertEqual(finished.returncode, 0, finished.stderr)
        for flag in ("force-all", "polar-setting"):
            self.assertIn(f"--{flag} has no effect: ", finished.stdout)

    def test_every_debug_mode_writes_its_pictures(self):
        folder = self.folder / "pictures"
        finished = self.tartan_calibrate(folder, "--projections", "homography", "--bag-freq", 2, "--debug-modes",
                                         "originalprojection", "pinholeprojection", "individualprojections",
                                         "reprojectionpoints", "targetpointcloud", "pointcloudprojection")
        self.assertEqual(finished.returncode, 0, finished.stderr)
        for pattern in ("frame_*_original.png", "frame_*_pinhole.png", "homography_*.png", "all_points.png",
                        "target_point_cloud.png", "view_point_cloud.png"):
            self.assertNotEqual(list(folder.glob(pattern)), [], pattern)
        for picture in folder.glob("*.png"):
            self.assertEqual(picture.read_bytes()[:4], b"\x89PNG", picture)

    def test_wrong_values_are_refused_in_one_line(self):
        for flags, words in ((["--debug-modes", "all"], ["--debug-modes", "all"]),
                             (["--projections", "fisheye"], ["--projections", "fisheye"]),
                             (["--projections", "pinhole", "--fovs", "90"], ["--fovs", "two rows"]),
                             (["--projections", "pinhole", "--poses", "a"], ["poses"])):
            finished = self.tartan_calibrate(self.folder / "refused", *flags)
            self.assertEqual(finished.returncode, 2, flags)
            self.assertEqual(len(finished.stderr.splitlines()), 1, finished.stderr)
            self.assertTrue(finished.stderr.startswith("[ERROR]"), finished.stderr)
            for word in words:
                self.assertIn(word, finished.stderr)
        self.assertFalse((self.folder / "refused").exists())

    def test_a_folder_that_cannot_be_made_is_named(self):
        (self.folder / "file").write_text("")
        finished = self.tartan_calibrate(self.folder / "file" / "below")
        self.assertEqual(finished.returncode, 1, finished.stderr)
        self.assertIn("--save_dir", finished.stderr)
        self.assertEqual(len(finished.stderr.splitlines()), 1, finished.stderr)


if __name__ == "__main__":
    unittest.main()
