"""Two camchains are compared, drawn, and refused where they do not belong together."""

import pathlib
import tempfile
import unittest

from programs import run

CAMERA = """cam{index}:
{baseline}  cam_overlaps: []
  camera_model: {model}
  distortion_coeffs: []
  distortion_model: none
  intrinsics: [{intrinsics}]
  resolution: [{width}, 480]
  rostopic: /cam{index}/image_raw
"""
BASELINE = """  T_cn_cnm1:
  - [1.0, 0.0, 0.0, {x}]
  - [0.0, 1.0, 0.0, 0.0]
  - [0.0, 0.0, 1.0, 0.0]
  - [0.0, 0.0, 0.0, 1.0]
"""
# The unified model in two ways of writing it.
OMNI = ("omni", "0.8, 360.0, 360.0, 320.0, 240.0")
EUCM = ("eucm", f"{0.8 / 1.8}, 1.0, 200.0, 200.0, 320.0, 240.0")


class CompareCalibrations(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def camchain(self, name, lens=OMNI, xs=(0.1,), width=640):
        text = ""
        for index, x in enumerate((None, *xs)):
            baseline = "" if x is None or x == "none" else BASELINE.format(x=x)
            text += CAMERA.format(index=index, baseline=baseline, model=lens[0], intrinsics=lens[1], width=width)
        path = self.folder / name
        path.write_text(text)
        return path

    def assert_refused(self, finished, code, *parts):
        self.assertEqual(finished.returncode, code, finished.stdout)
        self.assertEqual(len(finished.stderr.splitlines()), 1, finished.stderr)
        for part in ("[ERROR]", *parts):
            self.assertIn(part, finished.stderr)

    def test_other_models_of_one_lens_and_a_moved_camera(self):
        picture = self.folder / "map.png"
        finished = run("compare_calibrations", self.camchain("a.yaml"), self.camchain("b.yaml", EUCM, (0.103,)), "--output",
                       picture)
        self.assertEqual(finished.returncode, 0, finished.stderr)
        self.assertEqual(finished.stdout.count("differs by 0.000000 px rms"), 2, finished.stdout)
        self.assertIn("cam1 on cam0: place differs by 0.000000 mrad and 3.000000 mm", finished.stdout)
        self.assertEqual(picture.read_bytes()[:8], b"\x89PNG\r\n\x1a\n")

    def test_intrinsics_alone(self):
        finished = run("compare_calibrations", self.camchain("a.yaml", xs=("none",)), self.camchain("b.yaml"))
        self.assertEqual(finished.returncode, 0, finished.stderr)
        self.assertIn("no extrinsics", finished.stdout)
        self.assertNotIn("place differs", finished.stdout)

    def test_bad_input_is_one_line(self):
        good = self.camchain("a.yaml")
        self.assert_refused(run("compare_calibrations", good), 2, "two camchain files")
        self.assert_refused(run("compare_calibrations", good, self.camchain("b.yaml", width=752)), 1, "cam0", "sizes")
        self.assert_refused(run("compare_calibrations", good, self.camchain("c.yaml", xs=())), 1, "2 and 1 cameras")
        self.assert_refused(run("compare_calibrations", good, self.folder / "nowhere.yaml"), 1, "nowhere.yaml")
        self.assert_refused(run("compare_calibrations", good, good, "--distance", "0"), 2, "--distance")
        self.assert_refused(run("compare_calibrations", good, good, "--output", "map.jpg"), 1, "map.jpg", ".png")
        unwritable = self.folder / "nowhere" / "map.png"
        self.assert_refused(run("compare_calibrations", good, good, "--output", unwritable), 1, "nowhere")


if __name__ == "__main__":
    unittest.main()
