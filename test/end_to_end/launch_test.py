"""The launch files parse, describe each of their arguments, and start the program with a command line that it understands."""

import ast
import json
import os
import shlex
import tempfile
import unittest

import yaml

from programs import SOURCE, Recordings, free_port, run_in_workspace

LAUNCH_FILES = sorted(file.name for file in (SOURCE / "launch").glob("*.launch"))
CALIBRATING = ["calibrate.launch", "calibrate_rig.launch"]
LIVE = {"record.launch": ["/coverage_node", "/recorder", "/viewer"], "validate.launch": ["/validation_node", "/viewer"]}


class LaunchFiles(unittest.TestCase):
    def test_all_are_tested(self):
        self.assertEqual(LAUNCH_FILES, sorted([*CALIBRATING, *LIVE]))

    def test_every_argument_is_documented(self):
        for name in LAUNCH_FILES:
            finished = run_in_workspace(f"roslaunch --ros-args tartan_calib {name}")
            self.assertEqual(finished.returncode, 0, finished.stderr)
            self.assertIn("bag:" if name in CALIBRATING else "viewer", finished.stdout)
            self.assertNotIn("undocumented", finished.stdout)

    def test_the_program_understands_the_command_line(self):
        """It gets as far as the missing recording, whose name is relative to the user's folder."""
        with tempfile.TemporaryDirectory(prefix="tartan_calib_") as folder:
            for name in CALIBRATING:
                finished = run_in_workspace(f"roslaunch --args calibrate_cameras tartan_calib {name} bag:=nowhere.bag", cwd=folder)
                self.assertEqual(finished.returncode, 0, finished.stderr)
                self.assertIn("__name:=calibrate_cameras", finished.stdout)
                finished = run_in_workspace(shlex.join(shlex.split(finished.stdout)))
                self.assertEqual(finished.returncode, 1, finished.stderr)
                self.assertTrue(finished.stderr.startswith("[ERROR]"), finished.stderr)
                self.assertIn("nowhere.bag", finished.stderr)

    def test_live_files_start_their_nodes(self):
        for name, nodes in LIVE.items():
            for viewer in ("rqt", "image_view", "rviz"):
                finished = run_in_workspace(f"roslaunch --nodes tartan_calib {name} camchain:=a.yaml viewer:={viewer}")
                self.assertEqual(sorted(finished.stdout.split()), nodes, finished.stderr)

    def test_each_live_node_understands_its_parameters(self):
        """It gets as far as a file that is missing, whose name is relative to the user's folder."""
        for name, arguments in (("record.launch", "record:=false target:=nowhere.yaml"), ("validate.launch", "camchain:=nowhere.yaml")):
            with tempfile.TemporaryDirectory(prefix="tartan_calib_") as folder:
                environment = {**os.environ, "ROS_HOME": folder}
                command = f"roslaunch --port {free_port()} tartan_calib {name} {arguments}"
                finished = run_in_workspace(command, cwd=folder, env=environment)
                self.assertIn("[ERROR]", finished.stderr)
                self.assertIn("nowhere.yaml", finished.stderr)


class Launched(unittest.TestCase):
    """What roslaunch starts calibrates, with all that roslaunch adds to the command line."""

    @classmethod
    def setUpClass(cls):
        cls.recordings = Recordings()
        cls.addClassCleanup(cls.recordings.remove)
        cls.bag = cls.recordings.simulate("small", "--resolution", "320x256", "--views", 12)

    def launch(self, name, *arguments):
        camchain = self.bag.with_name("small-camchain.yaml")
        camchain.unlink(missing_ok=True)
        # The last word of the options takes further words, as those of roslaunch would be.
        command = ["roslaunch", "--port", str(free_port()), "tartan_calib", name, f"bag:={self.bag.name}", *arguments]
        environment = {**os.environ, "ROS_HOME": str(self.recordings.path / "ros")}
        finished = run_in_workspace(shlex.join(command), cwd=self.recordings.path, env=environment)
        self.assertIn("process has finished cleanly", finished.stdout + finished.stderr)
        self.assertEqual(finished.returncode, 0, finished.stderr)
        self.assertEqual(list(yaml.safe_load(camchain.read_text())), ["cam0"])

    def test_calibrate(self):
        target = self.recordings.target("small").name
        self.launch("calibrate.launch", f"target:={target}", "options:=--no-report --max-rounds 1 --topics /cam0/image_raw")

    def test_calibrate_rig(self):
        rig = {"topics": ["/cam0/image_raw"], "models": ["ds-none"], "target": self.recordings.target("small").name}
        (self.recordings.path / "rig.yaml").write_text(yaml.safe_dump(rig))
        self.launch("calibrate_rig.launch", "rig:=rig.yaml", "options:=--no-report --max-rounds 1")


class ViewerConfigurations(unittest.TestCase):
    def test_they_show_the_overlays_of_their_node(self):
        for name in ("coverage", "validation"):
            topics = {f"/{name}_node/cam{index}/overlay" for index in range(2)}
            rviz = yaml.safe_load((SOURCE / f"config/{name}.rviz").read_text())
            self.assertEqual({display["Image Topic"] for display in rviz["Visualization Manager"]["Displays"]}, topics)
            rqt = json.loads((SOURCE / f"config/{name}.perspective").read_text())["groups"]["pluginmanager"]["groups"].values()
            shown = {ast.literal_eval(plugin["groups"]["plugin"]["keys"]["topic"]["repr"]) for plugin in rqt}
            self.assertEqual(shown, topics)


if __name__ == "__main__":
    unittest.main()
