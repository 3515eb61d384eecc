"""The nodes that watch cameras, with the checks in test/rostest."""

import filecmp
import os
import shutil
import sys
import unittest

from programs import SOURCE, Recordings, calibrate, run_in_workspace


class LiveNodes(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.recordings = Recordings()
        cls.addClassCleanup(cls.recordings.remove)
        cls.folder = cls.recordings.path
        cls.recordings.simulate("live", "--cameras", 2, "--views", 24, "--resolution", "480x384")

    def rostest(self, name):
        """Runs test/rostest/<name>.test under a master of its own."""
        environment = {
            **os.environ,
            "PATH": os.pathsep.join([os.path.dirname(sys.executable), os.environ["PATH"]]),  # the Python that knows ROS
            "TARTAN_CALIB_TEST_FOLDER": str(self.folder),
            "ROS_HOME": str(self.folder / "ros"),
        }
        finished = run_in_workspace(f"rostest '{SOURCE}/test/rostest/{name}.test'", env=environment)
        self.assertEqual(finished.returncode, 0, finished.stdout + finished.stderr)

    def test_coverage_node(self):
        self.rostest("coverage_node")
        # What the service calibrated, calibrated by the program.
        shutil.copy(self.folder / "kept.bag", self.folder / "offline.bag")
        finished = calibrate(self.folder / "offline.bag", self.recordings.target("live"), ["ds-none", "ds-none"])
        self.assertEqual(finished.returncode, 0, finished.stderr)
        names = [self.folder / f"{name}-camchain.yaml" for name in ("kept", "offline")]
        self.assertTrue(filecmp.cmp(*names, shallow=False), [name.read_text() for name in names])

    def test_validation_node(self):
        self.rostest("validation_node")


if __name__ == "__main__":
    unittest.main()
