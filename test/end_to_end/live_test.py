"""The nodes that watch cameras, with the checks in test/rostest."""

import filecmp
import os
import shutil
import subprocess
import sys
import unittest

from programs import DEVEL, PROGRAMS, SOURCE, TIMEOUT_S, Recordings, assert_stopped, calibrate, free_port, interrupt_after, interrupt_when, run_in_workspace


class LiveNodes(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.recordings = Recordings()
        cls.addClassCleanup(cls.recordings.remove)
        cls.folder = cls.recordings.path
        cls.recordings.simulate("live", "--cameras", 2, "--views", 24, "--resolution", "480x384")

        cls.environment = {
            **os.environ,
            "PATH": os.pathsep.join([os.path.dirname(sys.executable), os.environ["PATH"]]),  # the Python that knows ROS
            "TARTAN_CALIB_TEST_FOLDER": str(cls.folder),
            "ROS_HOME": str(cls.folder / "ros"),
        }

    def rostest(self, name):
        """Runs test/rostest/<name>.test under a master of its own."""
        finished = run_in_workspace(f"rostest '{SOURCE}/test/rostest/{name}.test'", env=self.environment)
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

    def start(self, command, environment):
        """Starts a program that runs until the end of the test."""
        command = f"source '{DEVEL}/setup.bash' && exec {command}"
        process = subprocess.Popen(["bash", "-c", command], env=environment, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        self.addCleanup(process.stdout.close)
        self.addCleanup(process.wait, timeout=TIMEOUT_S)
        self.addCleanup(process.terminate)
        return process

    def node_with_views(self, recording, prefix):
        """A coverage node that was shown a recording, and the environment of its master."""
        environment = self.start_master()
        node = self.start_node(recording, prefix, environment)
        played = run_in_workspace(f"rosbag play --quiet --wait-for-subscribers --rate 4 {self.folder}/{recording}.bag", env=environment)
        self.assertEqual(played.returncode, 0, played.stderr)
        return node, environment

    def start_master(self):
        """The environment of nodes of the test's own."""
        port = free_port()
        environment = {**self.environment, "ROS_MASTER_URI": f"http://localhost:{port}"}
        master = self.start(f"rosmaster --core -p {port}", environment)
        while not run_in_workspace("rosparam list", env=environment).stdout:
            self.assertIsNone(master.poll())
        return environment

    def start_node(self, recording, prefix, environment):
        return self.start(f"stdbuf -oL {PROGRAMS / 'coverage_node'} _topics:='/cam0/image_raw /cam1/image_raw' _models:='ds-none ds-none' "
                          f"_target:={self.recordings.target(recording)} _output:={prefix}", environment)

    def test_a_folder_that_is_missing_ends_the_node_at_once(self):
        prefix = self.folder / "nowhere" / "live"
        node = self.start_node("live", prefix, self.start_master())
        output, _ = node.communicate(timeout=TIMEOUT_S)
        self.assertEqual(node.returncode, 1, output)
        self.assertIn(f"parameter ~output: cannot write {prefix}.bag: folder {prefix.parent} cannot be written to", output)

    def test_a_folder_that_went_away_is_named_without_advice_for_the_program(self):
        folder = self.folder / "gone"
        folder.mkdir()
        node, environment = self.node_with_views("live", folder / "live")
        folder.rmdir()
        answer = run_in_workspace("rosservice call --wait /coverage_node/calibrate", env=environment)
        self.assertIn(f"to be written to {folder}/live.bag", answer.stdout)
        output = interrupt_after("failed:", node).output
        self.assertIn(f"folder {folder} cannot be written to", output)
        self.assertNotIn("--bag", output)

    def test_ctrl_c_ends_a_calibration_and_leaves_whole_files_alone(self):
        node, environment = self.node_with_views("live", self.folder / "stopped")
        # The answer is not waited for: the client takes as long to print it as the calibration to end.
        self.start("rosservice call --wait /coverage_node/calibrate", environment)
        stopped = interrupt_after("wrote", node)
        assert_stopped(self, stopped, "the calibration was stopped; its views are in", returncode=0)
        self.assertEqual([file.name for file in self.folder.glob("stopped*")], ["stopped.bag"])

    def test_ctrl_c_while_the_views_are_written_leaves_no_bag(self):
        # ROS takes a tenth of a second to tell of a signal; the views of large images take longer to write.
        self.recordings.simulate("large", "--cameras", 2, "--views", 24, "--resolution", "1600x1280")
        node, environment = self.node_with_views("large", self.folder / "unwritten")
        self.start("rosservice call --wait /coverage_node/calibrate", environment)
        stopped = interrupt_when((self.folder / "unwritten.bag.partial").exists, node)
        assert_stopped(self, stopped, "of which 0 were written; ~calibrate writes them", returncode=0)
        self.assertIn("the calibration was stopped; its views were not written", stopped.output)
        self.assertEqual(list(self.folder.glob("unwritten*")), [])


if __name__ == "__main__":
    unittest.main()
