"""Shows the images of a bag to a node, and waits for what the node publishes. Nothing sleeps: every wait is for a condition."""

import copy
import threading
import time

import numpy
import rosbag
import rospy
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from sensor_msgs.msg import Image

TOPICS = ("/cam0/image_raw", "/cam1/image_raw")

# More than anything here takes under load.
DEADLINE_S = 60.0


class Received:
    """The messages of a topic, by arrival."""

    def __init__(self, topic, message_type, on_change):
        self.messages = []
        self._on_change = on_change
        self.subscriber = rospy.Subscriber(topic, message_type, self._add)

    def _add(self, message):
        with self._on_change:
            self.messages.append(message)
            self._on_change.notify_all()


class LiveCameras:
    def __init__(self, node, bag):
        self.node = node
        self._changed = threading.Condition()
        self.publishers = [rospy.Publisher(topic, Image, queue_size=1) for topic in TOPICS]
        self.overlays = [self.receive(f"/{node}/cam{index}/overlay", Image) for index in range(len(TOPICS))]
        self.diagnostics = self.receive("/diagnostics", DiagnosticArray)
        self.views = self._views(bag)
        self._last_stamp = rospy.Time(1)
        connected = lambda: all(publisher.get_num_connections() > 0 for publisher in self.publishers) and all(
            overlay.subscriber.get_num_connections() > 0 for overlay in self.overlays)
        self.wait(connected, "the node subscribes and publishes")

    @staticmethod
    def _views(bag):
        """Lists of images with equal stamps, one per camera."""
        views = {}
        with rosbag.Bag(str(bag)) as opened:
            for topic, message, _ in opened.read_messages(topics=list(TOPICS)):
                # read_messages makes its own classes
                image = Image(height=message.height, width=message.width, encoding=message.encoding, step=message.step, data=message.data)
                image.header.stamp = rospy.Time(message.header.stamp.secs, message.header.stamp.nsecs)
                views.setdefault(message.header.stamp, {})[topic] = image
        return [[view[topic] for topic in TOPICS] for _, view in sorted(views.items()) if len(view) == len(TOPICS)]

    def receive(self, topic, message_type):
        return Received(topic, message_type, self._changed)

    def wait(self, condition, what):
        """Returns what the condition returns once that is true."""
        deadline = time.monotonic() + DEADLINE_S
        with self._changed:
            while True:
                value = condition()
                if value:
                    return value
                left = deadline - time.monotonic()
                assert left > 0, f"waited {DEADLINE_S} s in vain: {what}"
                self._changed.wait(min(left, 0.1))  # not every condition is about messages

    def show(self, images, cameras=(0, 1)):
        """Publishes an image per camera, all of one new time, and returns that time. A recording may be shown again."""
        self._last_stamp += rospy.Duration(0, 250_000_000)
        for camera, image in zip(cameras, images):
            image.header.stamp = self._last_stamp
            self.publishers[camera].publish(image)
        return self._last_stamp

    def overlay_of(self, camera, stamp):
        """The overlay of the camera's image of that time."""
        found = lambda: [image for image in self.overlays[camera].messages if image.header.stamp == stamp]
        return self.wait(found, f"overlay of cam{camera} at {stamp}")[0]

    def show_and_wait(self, images, cameras=(0, 1)):
        stamp = self.show(images, cameras)
        return [self.overlay_of(camera, stamp) for camera in cameras]

    def show_all(self):
        """Every view, each once the last one was processed: none is dropped."""
        for view in self.views:
            self.show_and_wait(view)

    def wait_for_status(self, camera, condition, what, meanwhile=lambda: None):
        """The first status from now on of which the condition holds, of (level, message, values), and its values. A status is
        about what happened since the one before, so `meanwhile` is done before each of them."""
        first = len(self.diagnostics.messages)
        deadline = time.monotonic() + DEADLINE_S
        while time.monotonic() < deadline:
            meanwhile()
            array = self.wait(lambda: self.diagnostics.messages[first:], what)[0]
            first += 1
            for status in array.status:
                values = {pair.key: pair.value for pair in status.values}
                if status.name == f"/{self.node}: cam{camera}" and condition(status.level, status.message, values):
                    return status, values
        raise AssertionError(f"waited {DEADLINE_S} s in vain: {what}")


def pixels(image):
    return numpy.frombuffer(image.data, numpy.uint8).reshape(image.height, image.width, -1)


class SurvivesFaults:
    """Tests of any node that watches the `cameras` of its test case: what goes wrong with one stops nothing."""

    def test_survives_a_topic_that_stops(self):
        for view in self.cameras.views[:5]:
            self.cameras.show_and_wait(view[:1], cameras=[0])
        self.cameras.wait_for_status(1, lambda level, *_: level == DiagnosticStatus.STALE, "cam1 is known to have stopped")
        self.cameras.show_and_wait(self.cameras.views[0])

    def test_survives_broken_images(self):
        whole = self.cameras.views[0][1]
        broken = [copy.deepcopy(whole) for _ in range(4)]
        broken[0].data = whole.data[: len(whole.data) // 2]
        broken[1].encoding = "no such encoding"
        broken[2].width = broken[2].height = broken[2].step = 0
        broken[3].step = 2**31
        for image in broken:
            show = lambda image=image: self.cameras.show([image], cameras=[1])
            self.cameras.wait_for_status(1, lambda _, message, __: message.startswith("broken image"), "it is told", show)
        self.cameras.show_and_wait(self.cameras.views[0])
