"""A rendered recording calibrates to its truth, from every kind of input, and to the same bytes every time."""

import re
import shutil
import unittest

import yaml

from programs import Recordings, calibrate, run

FILES = ["camchain.yaml", "results-cam.txt", "calibration.yaml", "poses-cam0.csv", "corners.csv"]
MODELS = ["ds-none", "ds-none"]
EXPORTS = ["--export-poses", "--export-corners"]

# Of this recording of 24 views of 640x512 noise leaves a third of the first and a tenth of the others. Corners in the wrong order
# or half a pixel off are far outside.
MAX_PROJECTION_PX = 0.01
MAX_CENTRE_PX = 0.07
MAX_BASELINE_M = 7e-5


class SimulatedRig(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.recordings = Recordings()
        cls.addClassCleanup(cls.recordings.remove)
        arguments = ["--cameras", 2, "--resolution", "640x512", "--views", 24, "--yaw", 8]
        cls.bag = cls.recordings.simulate("rig", *arguments)
        cls.target = cls.recordings.target("rig")
        cls.first = calibrate(cls.bag, cls.target, MODELS, extra=EXPORTS)

    def output(self, name, base="rig"):
        return self.recordings.path / f"{base}-{name}"

    def texts(self, base="rig"):
        return {name: self.output(name, base).read_bytes() for name in FILES}

    def test_exits_with_0_and_writes_all_files(self):
        self.assertEqual(self.first.returncode, 0, self.first.stderr)
        for name in FILES:
            self.assertTrue(self.output(name).exists(), name)

    def test_messages_that_scripts_look_for_are_there(self):
        for line in ("Initializing cam0:", "Calibration complete.", "Results written to:", "Camera-system parameters:"):
            self.assertIn(line, self.first.stdout)

    def test_the_camchain_is_the_truth(self):
        result, truth = (yaml.safe_load(self.output(name).read_text()) for name in ("camchain.yaml", "truth-camchain.yaml"))
        self.assertEqual(list(result), list(truth))
        for name, camera in truth.items():
            for value, true_value in zip(result[name]["intrinsics"][4:], camera["intrinsics"][4:]):
                self.assertAlmostEqual(value, true_value, delta=MAX_CENTRE_PX)
        # Not the focal lengths: xi and alpha make up for theirs.
        compared = run("compare_calibrations", self.output("camchain.yaml"), self.output("truth-camchain.yaml"))
        differences = [float(rms) for rms in re.findall(r"differs by ([\d.]+) px rms", compared.stdout)]
        self.assertEqual(len(differences), len(truth), compared.stdout)
        self.assertLess(max(differences), MAX_PROJECTION_PX)
        for row, true_row in zip(result["cam1"]["T_cn_cnm1"], truth["cam1"]["T_cn_cnm1"]):
            self.assertAlmostEqual(row[3], true_row[3], delta=MAX_BASELINE_M)

    def test_parameters_that_make_up_for_each_other_do_not_keep_the_solve_from_its_end(self):
        # Through a narrow lens omni-radtan's minimum is the floor of a bent valley.
        bag = self.recordings.simulate("valley", "--lens", "pinhole60", "--resolution", "320x256", "--views", 24, "--seed", 5538,
                                       "--cameras", 2, "--hands", 0.4, "--noise", 2, "--tilt", 60)
        finished = calibrate(bag, self.recordings.target("valley"), ["omni-radtan"] * 2)
        self.assertEqual(finished.returncode, 0, finished.stderr)
        record = yaml.safe_load(self.output("calibration.yaml", "valley").read_text())
        self.assertLess(record["solution"]["iterations"], 40)
        self.assertNotIn("did not converge", finished.stderr)

    def test_two_runs_write_the_same_bytes_whatever_the_threads(self):
        before = self.texts()
        again = calibrate(self.bag, self.target, MODELS, extra=EXPORTS)
        self.assertEqual(again.returncode, 0)
        self.assertEqual(before, self.texts())
        single = calibrate(self.bag, self.target, MODELS, extra=[*EXPORTS, "--threads", 1])
        self.assertEqual(single.returncode, 0)
        for name in set(FILES) - {"calibration.yaml"}:  # which keeps the command
            self.assertEqual(before[name], self.texts()[name], name)

    def test_corners_lead_to_the_same_camchain(self):
        corners = self.recordings.path / "again-corners.csv"
        shutil.copy(self.output("corners.csv"), corners)
        finished = run("calibrate_cameras", "--corners", corners, "--target", self.target, "--models", *MODELS, "--no-report")
        self.assertEqual(finished.returncode, 0, finished.stderr)
        first, again = (yaml.safe_load(self.output("camchain.yaml", base).read_text()) for base in ("rig", "again"))
        for name in first:
            for value, other in zip(first[name]["intrinsics"], again[name]["intrinsics"]):
                self.assertAlmostEqual(value, other, delta=2e-4 * max(1.0, abs(value)))  # the file has 1e-4 px

    def test_beside_corners_a_bag_gives_only_its_name(self):
        bag, corners = self.recordings.path / "named.bag", self.output("corners.csv")
        finished = calibrate(bag, self.target, MODELS, extra=["--corners", corners])
        self.assertEqual(finished.returncode, 0, finished.stderr)
        self.assertIn(f"the images of {bag} are not read", finished.stdout)
        self.assertTrue(self.output("camchain.yaml", "named").exists())

    def test_a_bag_made_of_a_folder_calibrates_as_the_folder_does(self):
        folder, bag = self.recordings.path / "folder", self.recordings.path / "packed.bag"
        views = ["--resolution", "640x512", "--views", 10]
        self.assertEqual(run("simulate", "--output-dir", folder, *views).returncode, 0)
        target = next(self.recordings.path.glob("folder*-target.yaml"), None) or next(folder.glob("*target.yaml"))
        self.assertEqual(run("make_bag", "--folder", folder, "--output-bag", bag).returncode, 0)
        for recording in (folder, bag):
            finished = calibrate(recording, target, ["ds-none"])
            self.assertEqual(finished.returncode, 0, finished.stderr)
        camchains = [(self.recordings.path / f"{base}-camchain.yaml").read_bytes() for base in ("folder", "packed")]
        self.assertEqual(*camchains)


if __name__ == "__main__":
    unittest.main()
