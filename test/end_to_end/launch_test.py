"""The launch files parse, describe each of their arguments, and start the program with a command line that it understands."""

import shlex
import tempfile
import unittest

from programs import SOURCE, run_in_workspace

LAUNCH_FILES = sorted(file.name for file in (SOURCE / "launch").glob("*.launch"))


class LaunchFiles(unittest.TestCase):
    def test_there_are_two(self):
        self.assertEqual(LAUNCH_FILES, ["calibrate.launch", "calibrate_rig.launch"])

    def test_every_argument_is_documented(self):
        for name in LAUNCH_FILES:
            finished = run_in_workspace(f"roslaunch --ros-args tartan_calib {name}")
            self.assertEqual(finished.returncode, 0, finished.stderr)
            self.assertIn("bag:", finished.stdout)
            self.assertNotIn("undocumented", finished.stdout)

    def test_the_program_understands_the_command_line(self):
        """It gets as far as the missing recording, whose name is relative to the user's folder."""
        with tempfile.TemporaryDirectory(prefix="tartan_calib_") as folder:
            for name in LAUNCH_FILES:
                finished = run_in_workspace(f"roslaunch --args calibrate_cameras tartan_calib {name} bag:=nowhere.bag", cwd=folder)
                self.assertEqual(finished.returncode, 0, finished.stderr)
                words = shlex.split(finished.stdout)
                command = " ".join(shlex.quote(word) for word in words if not word.startswith("__"))
                finished = run_in_workspace(command)
                self.assertEqual(finished.returncode, 1, finished.stderr)
                self.assertTrue(finished.stderr.startswith("[ERROR]"), finished.stderr)
                self.assertIn("nowhere.bag", finished.stderr)


if __name__ == "__main__":
    unittest.main()
