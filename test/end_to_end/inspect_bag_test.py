"""inspect_bag tells what is in a recording, and the command it ends with calibrates."""

import shlex
import unittest

import rosbag
from sensor_msgs.msg import CompressedImage

from programs import Recordings, assert_stopped, interrupt_when, run, shows_bar, start_on_terminal


class InspectBag(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.recordings = Recordings()
        cls.addClassCleanup(cls.recordings.remove)
        cls.bag = cls.recordings.simulate("rig 1", "--lens", "pinhole70", "--resolution", "480x400", "--views", 24, "--cameras", 2)
        cls.target = cls.recordings.target("rig 1")

    def test_the_command_at_the_end_calibrates(self):
        finished = run("inspect_bag", self.bag, "--target", self.target)
        self.assertEqual((finished.returncode, finished.stderr), (0, ""))
        command = shlex.split(finished.stdout.splitlines()[-1])
        self.assertEqual(command[:3], ["rosrun", "tartan_calib", "calibrate_cameras"])
        calibrated = run(*command[2:], "--no-report")
        self.assertEqual(calibrated.returncode, 0, calibrated.stderr)
        self.assertTrue((self.recordings.path / "rig 1-camchain.yaml").exists())

    def test_it_tells_rate_size_and_board_of_every_camera(self):
        lines = run("inspect_bag", self.bag, "--target", self.target).stdout.splitlines()
        for camera in ("/cam0/image_raw", "/cam1/image_raw"):
            self.assertIn(f"{camera}  (sensor_msgs/Image, mono8, 480 x 400)", lines)
        self.assertEqual(sum("24 in 5.8 s, 4.00 Hz" in line for line in lines), 2, lines)
        self.assertEqual(sum("in 24 of 24 images" in line for line in lines), 2, lines)

    def test_another_board_is_answered_with_the_size_that_is_there(self):
        board = self.recordings.path / "board.yaml"
        board.write_text(self.target.read_text().replace("tagCols: 6", "tagCols: 5"))
        finished = run("inspect_bag", self.bag, "--target", board)
        self.assertEqual(finished.returncode, 0, finished.stderr)
        self.assertIn("6 rows and 6 columns", finished.stdout)

    def test_without_a_target_it_says_that_no_board_was_looked_for(self):
        lines = run("inspect_bag", self.bag).stdout.splitlines()
        self.assertIn("Nothing speaks against a calibration (the board was not looked for: give --target).", lines)
        lines = run("inspect_bag", self.bag, "--target", self.target).stdout.splitlines()
        self.assertFalse(any("was not looked for" in line for line in lines), lines)

    def test_a_topic_that_calibrate_cameras_refuses_is_not_suggested(self):
        images = self.recordings.path / "images"
        rendered = run("simulate", "--output-dir", images, "--lens", "pinhole70", "--resolution", "480x400", "--views", 1)
        self.assertEqual(rendered.returncode, 0, rendered.stderr)
        png = next((images / "cam0").iterdir()).read_bytes()
        two_types = self.recordings.path / "two_types.bag"
        with rosbag.Bag(str(self.bag)) as original, rosbag.Bag(str(two_types), "w") as bag:
            for topic, message, time in original.read_messages():
                bag.write(topic, message, time)
                if topic == "/cam0/image_raw":  # the type of the first message is that of the topic
                    bag.write("/camera", CompressedImage(header=message.header, format="png", data=png), time)
                    bag.write("/camera", message, time)
        finished = run("inspect_bag", two_types, "--target", self.target)
        self.assertIn("/camera has messages that are not of the type that the bag says", finished.stdout)
        suggested = "--topics /cam0/image_raw /cam1/image_raw --models ds-none ds-none"
        self.assertTrue(finished.stdout.splitlines()[-1].endswith(suggested), finished.stdout)

    def test_ctrl_c_ends_it(self):
        process, terminal = start_on_terminal(self, "inspect_bag", self.bag, "--target", self.target)
        stopped = interrupt_when(lambda: shows_bar(terminal), process)
        assert_stopped(self, stopped, "of 48 images; nothing was written")

    def test_bad_input_is_one_line(self):
        text = self.recordings.path / "text.bag"
        text.write_text("no bag\n")
        (self.recordings.path / "empty").mkdir(exist_ok=True)
        for arguments, word in (([text], "text.bag"), ([self.recordings.path / "nowhere.bag"], "nowhere.bag"),
                                ([self.recordings.path / "empty"], "empty"), ([self.bag, "--target", "nowhere.yaml"], "nowhere.yaml")):
            finished = run("inspect_bag", *arguments)
            self.assertEqual(finished.returncode, 1, finished.stderr)
            self.assertRegex(finished.stderr, r"^\[ERROR\][^\n]*\n$")
            self.assertIn(word, finished.stderr)


if __name__ == "__main__":
    unittest.main()
