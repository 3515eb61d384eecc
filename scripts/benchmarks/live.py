"""What the nodes that watch cameras publish while a recording is shown to them."""

import concurrent.futures
import contextlib
import os
import socket
import subprocess
import sys

import numpy as np

from benchmarks.common import PROGRAMS, ROOT, WORK

sys.path.insert(0, str(ROOT / "test" / "rostest"))  # live_cameras


def overlays(node, bag, **parameters):
    """Of every view in turn, the picture that the node publishes of cam0 (RGB). `bag` has the topics of two cameras."""
    with concurrent.futures.ProcessPoolExecutor(1) as process:  # rospy has one master in its life
        return process.submit(shown, node, bag, parameters).result()


def shown(node, bag, parameters):
    with socket.socket() as probe:
        probe.bind(("localhost", 0))
        port = probe.getsockname()[1]
    os.environ["ROS_MASTER_URI"] = f"http://localhost:{port}"
    os.environ.setdefault("ROS_HOME", str(WORK / "ros"))
    words = [f"_{name}:={value}" for name, value in parameters.items()]
    with ended("rosmaster", "--core", "-p", port), ended(PROGRAMS / node, *words):
        import rospy  # the master that it talks to is chosen by now
        from live_cameras import LiveCameras, pixels

        rospy.init_node("draw_docs", disable_signals=True)
        cameras = LiveCameras(node, bag)
        pictures = [np.array(pixels(cameras.show_and_wait(view)[0])[..., ::-1]) for view in cameras.views]
        rospy.signal_shutdown("all is shown")
        return pictures


@contextlib.contextmanager
def ended(*command):
    """A program that is ended with the block."""
    process = subprocess.Popen([str(word) for word in command], stdout=subprocess.DEVNULL)
    try:
        yield process
    finally:
        process.terminate()
        process.wait()
