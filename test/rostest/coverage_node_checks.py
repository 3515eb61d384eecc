#!/usr/bin/env python3
"""What coverage_node does with the cameras that it watches; run by rostest."""

import sys
import unittest
from pathlib import Path

import rospy
import rostest
import yaml
from diagnostic_msgs.msg import DiagnosticStatus
from live_cameras import LiveCameras, SurvivesFaults, pixels
from sensor_msgs.msg import Image
from std_msgs.msg import String
from std_srvs.srv import Trigger

ENOUGH_VIEWS = 16


class CoverageNode(SurvivesFaults, unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("coverage_node_checks")
        cls.folder = Path(rospy.get_param("~folder"))
        cls.cameras = LiveCameras("coverage_node", cls.folder / "live.bag")
        cls.advice = cls.cameras.receive("/coverage_node/advice", String)
        cls.progress = cls.cameras.receive("/coverage_node/progress", String)
        cls.camchain = cls.cameras.receive("/coverage_node/camchain", String)
        cls.calibrate = rospy.ServiceProxy("/coverage_node/calibrate", Trigger)
        cls.reset = rospy.ServiceProxy("/coverage_node/reset", Trigger)
        cls.calibrate.wait_for_service()

    def setUp(self):
        """Every test begins with the views of the whole recording."""
        self.assertTrue(self.reset().success)
        self.cameras.show_all()

    def views_kept(self, camera):
        _, values = self.cameras.wait_for_status(camera, lambda *_: True, "a status")
        return int(values["views kept"])

    def test_overlay_is_published_and_bounded(self):
        image, _ = self.cameras.show_and_wait(self.cameras.views[0])
        self.assertEqual(image.encoding, "bgr8")
        self.assertEqual(image.width, 320)
        colours = pixels(image).astype(int)
        self.assertGreater((abs(colours[..., 0] - colours[..., 2]) > 30).mean(), 0.05)  # heat map and rings, not a grey image
        self.assertTrue(self.advice.messages[-1].data)

    def test_diagnostics_tell_what_happens(self):
        status, values = self.cameras.wait_for_status(0, lambda level, *_: level == DiagnosticStatus.STALE, "no images any more")
        self.assertEqual(status.hardware_id, "/cam0/image_raw")
        self.assertGreaterEqual(int(values["views kept"]), ENOUGH_VIEWS)
        self.assertEqual(int(values["dropped"]), 0)
        self.assertGreater(float(values["blur [px]"]), 0.3)

    def test_service_calibrates_as_the_program_does_with_the_same_bag(self):
        """The folder's other half of the comparison is made by the test that started this one."""
        answer = self.calibrate()
        self.assertTrue(answer.success, answer.message)
        self.assertFalse(self.calibrate().success)  # one at a time
        ended = lambda: [line.data for line in self.progress.messages if line.data.startswith(("finished", "failed"))]
        line = self.cameras.wait(ended, "the calibration ends")[-1]
        self.assertTrue(line.startswith("finished"), line)
        published = self.cameras.wait(lambda: self.camchain.messages, "a camchain")[-1].data
        self.assertEqual(published, (self.folder / "kept-camchain.yaml").read_text())
        self.assertEqual(set(yaml.safe_load(published)), {"cam0", "cam1"})
        self.assertTrue((self.folder / "kept.bag").exists())

    def test_survives_another_resolution(self):
        before = self.views_kept(1)
        small = Image(height=120, width=160, encoding="mono8", step=160, data=bytes(120 * 160))
        show = lambda: self.cameras.show_and_wait([self.cameras.views[0][0], small])
        self.assertEqual(show()[1].width, 160)
        self.cameras.wait_for_status(1, lambda _, message, __: message == "other image size", "cam1 has another size", show)
        self.cameras.show_and_wait(self.cameras.views[0])
        self.assertEqual(self.views_kept(1), before)

    def test_reset_forgets_the_views(self):
        answer = self.reset()
        self.assertIn("forgot", answer.message)
        self.assertEqual(self.views_kept(0), 0)


if __name__ == "__main__":
    rostest.rosrun("tartan_calib", "coverage_node_checks", CoverageNode, sys.argv)
