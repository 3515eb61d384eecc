"""TartanCalib's command line: its flags, its files, its pictures, and the views that find more corners."""

import csv
import math
import struct
import unittest
import zlib

import yaml

from programs import Recordings, assert_stopped, calibrate, interrupt_after, interrupt_when, run, start

FALSE_PX = 2.0


def corners_in(file):
    """(camera, stamp, id) to (u, v, used)."""
    lines = [line for line in file.read_text().splitlines() if not line.startswith(("#", "camera"))]
    return {tuple(row[:3]): (float(row[3]), float(row[4]), row[8] == "1") for row in csv.reader(lines)}


class Picture:
    """What a PNG file of 8-bit colours holds, as far as its rows tell without undoing their filters."""

    def __init__(self, file):
        data = file.read_bytes()
        assert data[:8] == b"\x89PNG\r\n\x1a\n", file
        self.size = struct.unpack(">II", data[16:24])
        assert data[24:26] == bytes([8, 2]), file  # bits per channel, RGB
        packed, place = b"", 8
        while place < len(data):
            length, kind = struct.unpack(">I4s", data[place:place + 8])
            packed += data[place + 8:place + 8 + length] if kind == b"IDAT" else b""
            place += length + 12
        row, pixels = 1 + 3 * self.size[0], zlib.decompress(packed)
        self._rows = [pixels[i + 1:i + row] for i in range(0, len(pixels), row)]  # without the number of the filter

    def has_colour(self):
        """Filters treat the channels alike, so that grey stays grey."""
        return any(row[0::3] != row[1::3] or row[0::3] != row[2::3] for row in self._rows)

    def has_texture(self):
        """Many differences between neighbours, which a drawing on one colour has not."""
        return len(set(b"".join(self._rows))) > 128


class WideRecording(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.recordings = Recordings()
        cls.addClassCleanup(cls.recordings.remove)
        cls.folder = cls.recordings.path
        cls.bag = cls.recordings.simulate("wide", "--resolution", "640x512", "--views", 16, "--hands", 0.5)
        cls.target = cls.recordings.target("wide")
        cls.truth = corners_in(cls.folder / "wide-truth-corners.csv")

    def tartan_calibrate(self, save_dir, *flags, runner=run):
        return runner("tartan_calibrate", "--bag", self.bag, "--target", self.target, "--topics", "/cam0/image_raw", "--models",
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
        self.assertGreater(found["pinhole"], found["none"])


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

    def test_ctrl_c_in_a_round_keeps_what_detection_alone_gave(self):
        folder = self.folder / "stopped"
        stopped = interrupt_after("Started tartan calib", self.tartan_calibrate(folder, "--log_dest", "rig", runner=start))
        files = [folder / "rig0-camchain.yaml", folder / "rig0-results-cam.txt"]
        assert_stopped(self, stopped, f"; {files[0]} and {files[1]} are written")
        self.assertEqual(sorted(folder.iterdir()), files)

    def test_ctrl_c_in_the_debug_pictures_keeps_the_result(self):
        folder = self.folder / "pictures_stopped"
        process = self.tartan_calibrate(folder, "--log_dest", "rig", "--max-rounds", 0, "--debug-modes", "originalprojection",
                                        runner=start)
        stopped = interrupt_when(lambda: len(list(folder.glob("frame_*.png"))) > 2, process)
        assert_stopped(self, stopped, "in the pictures of --debug-modes; the results above are written and complete")
        self.assertTrue((folder / "rig1-camchain.yaml").exists())
        self.assertEqual({file.suffix for file in folder.iterdir()}, {".yaml", ".txt", ".png"})

    def test_flags_without_effect_say_why(self):
        finished = self.tartan_calibrate(self.folder / "noted", "--force_all", "--polar_setting", 1, "--max-rounds", 0)
        self.assertEqual(finished.returncode, 0, finished.stderr)
        for flag in ("force_all", "polar_setting"):
            self.assertIn(f"--{flag} has no effect: ", finished.stdout)

    def test_every_debug_mode_writes_its_pictures(self):
        folder = self.folder / "pictures"
        finished = self.tartan_calibrate(folder, "--projections", "homography", "--bag-freq", 2, "--debug-modes",
                                         "originalprojection", "pinholeprojection", "individualprojections",
                                         "reprojectionpoints", "targetpointcloud", "pointcloudprojection")
        self.assertEqual(finished.returncode, 0, finished.stderr)
        self.check_pictures(folder, {"frame_*_original.png": (640, 512), "frame_*_pinhole.png": (1500, 1500),
                                     "homography_*.png": (1000, 1000), "all_points.png": (640, 512)},
                            of_images={"frame_*_original.png", "frame_*_pinhole.png", "homography_*.png"})
        for name in ("target_point_cloud.png", "view_point_cloud.png"):
            self.assertTrue(Picture(folder / name).has_colour(), name)

    def test_each_face_of_a_cube_is_a_picture(self):
        folder = self.folder / "faces"
        finished = self.tartan_calibrate(folder, "--projections", "cube", "--resolutions", 300, "--resolutions", 400,
                                         "--debug-modes", "individualprojections")
        self.assertEqual(finished.returncode, 0, finished.stderr)
        for face in range(5):
            pictures = [Picture(file) for file in folder.glob(f"frame_*_projection_{face}.png")]
            self.assertEqual({picture.size for picture in pictures}, {(400, 300)})
            self.assertTrue(any(picture.has_colour() for picture in pictures), f"no corner on face {face}")
            self.assertTrue(any(picture.has_texture() for picture in pictures), f"nothing of the image on face {face}")

    def test_each_camera_of_a_rig_has_a_folder_of_pictures(self):
        bag = self.recordings.simulate("pair", "--lens", "pinhole70", "--resolution", "480x400", "--views", 8, "--cameras", 2)
        finished = run("tartan_calibrate", "--bag", bag, "--target", self.recordings.target("pair"), "--topics",
                       "/cam0/image_raw", "/cam1/image_raw", "--models", "pinhole-radtan", "pinhole-radtan", "--save_dir",
                       self.folder / "rig", "--no-report", "--max-rounds", 0, "--debug-modes", "originalprojection",
                       "reprojectionpoints")
        self.assertEqual(finished.returncode, 0, finished.stderr)
        for camera in ("cam0", "cam1"):
            self.check_pictures(self.folder / "rig" / camera, {"frame_*_original.png": (480, 400), "all_points.png": (480, 400)},
                                of_images={"frame_*_original.png"})
        self.assertEqual(list((self.folder / "rig").glob("*.png")), [])

    def test_corners_give_both_results_and_the_pictures_that_need_no_image(self):
        finished = self.tartan_calibrate(self.folder / "of_images", "--max-rounds", 0, "--export-corners")
        self.assertEqual(finished.returncode, 0, finished.stderr)
        folder = self.folder / "of_corners"
        finished = run("tartan_calibrate", "--corners", self.folder / "of_images/log1-corners.csv", "--target", self.target, "--models",
                       "ds-none", "--save_dir", folder, "--no-report", "--projections", "cube", "--debug-modes",
                       "originalprojection", "targetpointcloud", "reprojectionpoints")
        self.assertEqual(finished.returncode, 0, finished.stderr)
        self.assertIn("--debug-modes originalprojection has no effect: --corners brings no images", finished.stdout)
        self.assertIn("--projections has no effect: --corners brings no images", finished.stdout)
        self.assertEqual({file.name for file in folder.iterdir()},
                         {"log0-camchain.yaml", "log0-results-cam.txt", "log1-camchain.yaml", "log1-results-cam.txt",
                          "log1-calibration.yaml", "all_points.png", "target_point_cloud.png"})
        self.check_pictures(folder, {"all_points.png": (640, 512)})

    def check_pictures(self, folder, sizes, of_images=frozenset()):
        """Pictures of each pattern have the size, corners, and, where they show images, what these show."""
        for pattern, size in sizes.items():
            files = list(folder.glob(pattern))
            self.assertNotEqual(files, [], pattern)
            for file in files:
                picture = Picture(file)
                self.assertEqual(picture.size, size, file)
                self.assertTrue(picture.has_colour(), file)
                self.assertTrue(picture.has_texture() or pattern not in of_images, file)

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

    def test_log_dest_may_lie_in_folders(self):
        finished = self.tartan_calibrate(self.folder / "deep", "--log_dest", "sub/dir/x", "--max-rounds", 0)
        self.assertEqual(finished.returncode, 0, finished.stderr)
        self.assertTrue((self.folder / "deep/sub/dir/x1-camchain.yaml").exists())

    def test_a_folder_that_cannot_be_made_is_named(self):
        (self.folder / "file").write_text("")
        finished = self.tartan_calibrate(self.folder / "file" / "below")
        self.assertEqual(finished.returncode, 1, finished.stderr)
        self.assertIn("--save_dir", finished.stderr)
        self.assertEqual(len(finished.stderr.splitlines()), 1, finished.stderr)


if __name__ == "__main__":
    unittest.main()
