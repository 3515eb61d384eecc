#!/usr/bin/env python3
"""What validation_node says about a calibration; run by rostest."""

import sys
import unittest
from pathlib import Path

import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticStatus
from live_cameras import LiveCameras, SurvivesFaults
from sensor_msgs.msg import Image


class ValidationNode(SurvivesFaults, unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("validation_node_checks")
        cls.cameras = LiveCameras("validation_node", Path(rospy.get_param("~folder")) / "live.bag")

    def test_the_truth_explains_what_is_seen(self):
        self.cameras.show_all()
        for camera in range(2):
            _, values = self.cameras.wait_for_status(camera, lambda *_: True, "a status")
            self.assertGreaterEqual(int(values["images"]), len(self.cameras.views))
            for kind in ("intrinsics alone", "with the other cameras"):
                self.assertLess(float(values[f"{kind}: rms [px]"]), 0.2)

    def test_overlay_is_published_and_bounded(self):
        overlays = self.cameras.show_and_wait(self.cameras.views[0])
        self.assertEqual([(image.encoding, image.width) for image in overlays], [("bgr8", 320)] * 2)

    def test_survives_an_image_of_another_size(self):
        small = Image(height=120, width=160, encoding="mono8", step=160, data=bytes(120 * 160))
        show = lambda: self.cameras.show([small], cameras=[1])
        status, _ = self.cameras.wait_for_status(1, lambda level, *_: level == DiagnosticStatus.ERROR, "it is refused", show)
        self.assertIn("160x120", status.message)
        self.cameras.show_and_wait(self.cameras.views[0])


if __name__ == "__main__":
    rostest.rosrun("tartan_calib", "validation_node_checks", ValidationNode, sys.argv)
