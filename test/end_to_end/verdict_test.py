"""Every reason of a verdict comes from a rendered recording that has its fault, and is absent where the fault is."""

import math
import os
import re
import unittest

import rosbag

from programs import PROGRAMS, Recordings, run_command

PINHOLE = ["--lens", "pinhole80", "--models", "pinhole-radtan", "--resolution", "320x256", "--views", 24]
FISHEYE = ["--lens", "fisheye190", "--resolution", "320x256", "--views", 24]
RIG = [*FISHEYE, "--cameras", 2, "--yaw", 8]


def messages(bag):
    with rosbag.Bag(str(bag)) as file:
        return list(file.read_messages())


def share_beyond(degrees):
    """Part of the FISHEYE's lit image, in per cent, further from the axis than this."""
    def radius(angle_deg):  # the lens' data sheet
        return angle_deg * (1.0 - 0.01 * math.radians(angle_deg) ** 2)
    radii = [radius(95.0) * math.hypot(u - 159.5, v - 127.5) / (0.48 * 320) for u in range(320) for v in range(256)]
    return 100.0 * sum(radius(degrees) < r < radius(95.0) for r in radii) / sum(r < radius(95.0) for r in radii)


def sheared(image, rows_per_px):
    """The image with every row further to the left than the one above, as a rolling shutter sees what moves."""
    rows = [image.data[row * image.step:(row + 1) * image.step] for row in range(image.height)]
    shifts = [row // rows_per_px for row in range(image.height)]
    image.data = b"".join(row[shift:] + row[:shift] for row, shift in zip(rows, shifts))
    return image


def smudged(image):
    """The image with its lower left ninth and a bit more in grey."""
    data = bytearray(image.data)
    for row in range(2 * image.height // 3 - 2, image.height):
        data[row * image.step:row * image.step + image.width // 3 + 3] = bytes([128]) * (image.width // 3 + 3)
    image.data = bytes(data)
    return image


class VerdictOnRenderedRecordings(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.recordings = Recordings()
        cls.addClassCleanup(cls.recordings.remove)
        modules = cls.recordings.path / "modules"  # the verdict without the time that drawing takes
        modules.mkdir()
        (modules / "matplotlib.py").write_text("raise ImportError('not drawn', name='matplotlib')\n")
        cls.environment = {**os.environ, "PYTHONPATH": str(modules)}
        cls.pinhole = cls.recordings.simulate("pinhole", *PINHOLE)
        cls.rig = cls.recordings.simulate("rig", *RIG)

    def written(self, name, changed_messages):
        bag = self.recordings.path / f"{name}.bag"
        with rosbag.Bag(str(bag), "w") as file:
            for topic, message, time in changed_messages:
                file.write(topic, message, time)
        return bag

    def verdict(self, bag, models, target=None):
        """Grade and reasons, as the terminal has them."""
        target = target or self.recordings.target(bag.stem)
        finished = run_command(PROGRAMS / "calibrate_cameras", "--bag", bag, "--target", target, "--models", *models, "--topics",
                               *(f"/cam{index}/image_raw" for index in range(len(models))), env=self.environment)
        self.assertEqual(finished.returncode, 0, finished.stderr)
        grade = re.search(r"Verdict: (\w+)", finished.stdout).group(1)
        return grade, re.findall(r"^  ((?:usable|repeat): .*)$", finished.stdout, re.MULTILINE)

    def reason(self, verdict, pattern):
        """What the pattern's groups match, as numbers, in the one reason that has it."""
        found = [match for match in (re.search(pattern, text) for text in verdict[1]) if match]
        self.assertEqual(len(found), 1, f"'{pattern}' in {verdict}")
        return [float(group) for group in found[0].groups()]

    def pinhole_verdict(self, bag, target=None):
        return self.verdict(bag, ["pinhole-radtan"], target or self.recordings.target("pinhole"))

    def test_good_recordings_are_good(self):
        self.assertEqual(self.pinhole_verdict(self.pinhole), ("good", []))
        self.assertEqual(self.verdict(self.rig, ["ds-none", "ds-none"]), ("good", []))

    def test_board_that_stays_near_the_axis(self):
        bag = self.recordings.simulate("centre", *FISHEYE, "--reach", 0.1)
        verdict = self.verdict(bag, ["ds-none"])
        end, share, reach = self.reason(verdict, r"usable: cam0: no corner beyond (\d+) degrees .* where (\d+) % .*\(to (\d+) deg")
        farthest = float(re.search(r"max_polar_angle_deg: ([\d.]+)", (self.recordings.path / "centre-calibration.yaml").read_text())[1])
        self.assertAlmostEqual(end, farthest, delta=0.51)
        self.assertAlmostEqual(reach, 95.0, delta=2.0)  # of a lens of 190 degrees
        self.assertAlmostEqual(share, share_beyond(end + 2.0), delta=3.0)  # 2 degrees count as reached

    def test_rim_whose_corners_the_model_cannot_follow(self):
        bag = self.recordings.simulate("rim", "--lens", "fisheye190", "--resolution", "640x512", "--views", 24)
        verdict = self.verdict(bag, ["omni-none"])
        rejected, end, reach = self.reason(verdict, r"usable: cam0: all (\d+) corners beyond (\d+) degrees .* were rejected, where .* "
                                                    r"\(to (\d+) degrees\): omni-none does not follow the lens there, try ds-none, ")
        record = (self.recordings.path / "rim-calibration.yaml").read_text()
        self.assertAlmostEqual(end, float(re.search(r"max_polar_angle_deg: ([\d.]+)", record)[1]), delta=0.51)
        self.assertLessEqual(rejected, int(re.search(r"outliers: (\d+)", record)[1]))
        self.assertGreater(reach, end)
        self.assertNotIn("hold the board there", " ".join(verdict[1]))

    def test_part_of_the_image_without_corners(self):
        bag = self.written("smudge", [(topic, smudged(image), time) for topic, image, time in messages(self.pinhole)])
        self.reason(self.pinhole_verdict(bag), r"usable: cam0: no corner in these parts of the image: lower left;")

    def test_views_that_are_all_alike(self):
        bag = self.recordings.simulate("alike", *PINHOLE[:-1], 16, "--reach", 0.1, "--tilt", 2)
        grade, reasons = self.verdict(bag, ["pinhole-radtan"])
        percent, = self.reason((grade, reasons), r"usable: cam0: views too similar: focal length uncertain to ([\d.]+) %")
        results = (self.recordings.path / "alike-results-cam.txt").read_text()
        focal, stdev = (float(number) for number in re.search(r"projection: \[(\S+) .*\+- \[(\S+) ", results).groups())
        self.assertAlmostEqual(percent, 100.0 * stdev / focal, delta=0.3)

    def test_few_and_flat_views(self):
        bag = self.recordings.simulate("flat", *PINHOLE[:-1], 3, "--reach", 0.1, "--tilt", 5)
        verdict = self.verdict(bag, ["pinhole-radtan"])
        self.assertEqual(verdict[0], "repeat")
        self.reason(verdict, r"repeat: cam0: only 3 views")
        self.reason(verdict, r"cam0: too little data: the projection is uncertain to [\d.]+ px")
        self.reason(verdict, r"cam0: views too similar")

    def test_sizes_in_the_target_file_that_are_not_the_boards(self):
        target = self.recordings.path / "wrong-target.yaml"
        target.write_text(re.sub("tagSpacing: .*", "tagSpacing: 0.4", self.recordings.target("pinhole").read_text()))
        rms, = self.reason(self.pinhole_verdict(self.pinhole, target), r"usable: cam0: large residuals \(rms ([\d.]+) px\)")
        self.assertGreater(rms, 0.6)

    def test_sizes_that_are_far_from_the_boards(self):
        target = self.recordings.path / "far-target.yaml"
        target.write_text(re.sub("tagSpacing: .*", "tagSpacing: 0.6", self.recordings.target("pinhole").read_text()))
        verdict = self.pinhole_verdict(self.pinhole, target)
        self.assertEqual(verdict[0], "repeat")
        rms, = self.reason(verdict, r"repeat: cam0: large residuals \(rms ([\d.]+) px\)")
        self.assertGreater(rms, 1.5)

    def test_few_flat_views_of_a_model_with_more_parameters_than_they_tell(self):
        bag = self.recordings.simulate("open", "--lens", "pinhole70", *PINHOLE[4:6], "--views", 6, "--reach", 0.1, "--tilt", 3)
        verdict = self.verdict(bag, ["ds-none"])
        self.assertEqual(verdict[0], "repeat")
        self.reason(verdict, r"repeat: the views do not determine cam0 projection\[0\], .*: record the board at more angles and distances")

    def test_few_views_through_a_narrow_lens_of_a_model_for_wide_ones(self):
        bag = self.recordings.simulate("endless", "--lens", "pinhole40", "--resolution", "480x360", "--views", 4,
                                       "--tilt", 43, "--seed", 1)
        verdict = self.verdict(bag, ["omni-radtan"])
        self.assertEqual(verdict[0], "repeat")
        iterations, = self.reason(verdict, r"repeat: the solver did not converge within (\d+) iterations: .* fewer parameters")
        self.assertGreaterEqual(iterations, 100)
        self.assertEqual(self.verdict(bag, ["pinhole-radtan"])[0], "usable")

    def test_frames_that_a_rolling_shutter_bent(self):
        changed = [(topic, sheared(image, 12) if index % 6 == 0 else image, time)
                   for index, (topic, image, time) in enumerate(messages(self.pinhole))]
        percent, outliers = self.reason(self.pinhole_verdict(self.written("sheared", changed)),
                                        r"usable: cam0: (\d+) % of the corners were rejected \((\d+) outliers, 0 ")
        self.assertAlmostEqual(percent, 100.0 * outliers / (24 * 100), delta=2.0)  # about 100 corners are in a view

    def test_lens_that_the_model_cannot_follow(self):
        verdict = self.verdict(self.rig, ["eucm-none", "ds-none"])
        size, start, end = self.reason(verdict, r"usable: cam0: residuals follow the angle \(([\d.]+) px outwards .* at (\d+) to (\d+) "
                                                r"degrees\): eucm-none is too simple for this lens, try ds-none, pinhole-equi or omni-radtan")
        self.assertGreater(size, 0.03)
        self.assertEqual((start, end), (90.0, 100.0))
        self.assertFalse([text for text in verdict[1] if "cam1" in text], verdict)

    def test_lens_that_is_far_from_the_model(self):
        verdict = self.verdict(self.rig, ["pinhole-radtan", "ds-none"])
        self.assertEqual(verdict[0], "repeat")
        self.reason(verdict, r"repeat: cam0: large residuals \(rms ([\d.]+) px\): .*, or a model that cannot follow the lens")
        self.reason(verdict, r"repeat: cam0: residuals follow the angle .* pinhole-radtan is too simple for this lens, try pinhole-equi")

    def test_camera_that_changed_between_views(self):
        other = messages(self.recordings.simulate("other", *PINHOLE, "--seed", 2))
        mixed = [pair[index % 2] for index, pair in enumerate(zip(messages(self.pinhole), other))]
        difference, times = self.reason(self.pinhole_verdict(self.written("mixed", mixed)),
                                        r"usable: cam0: even and odd views give calibrations ([\d.]+) px apart, (\d+) times")
        self.assertGreater(difference, 0.1)
        self.assertGreaterEqual(times, 4)

    def test_cameras_that_are_not_in_sync(self):
        bag = self.recordings.simulate("late", *RIG[:-5], 40, *RIG[-4:], "--delay", 4)
        verdict = self.verdict(bag, ["ds-none", "ds-none"])
        delay, stamps, motion = self.reason(verdict, r"usable: cam1: stereo pairs ([\d.]+) ms apart \(their stamps: ([\d.]+) ms\), "
                                                     r"in which the board moves by ([\d.]+) px")
        self.assertAlmostEqual(delay, 4.0, delta=0.4)
        self.assertEqual(stamps, 0.0)
        self.assertAlmostEqual(motion, 0.8, delta=0.15)  # 0.2 px/ms over all true corners

    def test_cameras_that_are_far_from_sync(self):
        verdict = self.verdict(self.recordings.simulate("later", *RIG, "--delay", 15), ["ds-none", "ds-none"])
        self.assertEqual(verdict[0], "repeat")
        delay, motion = self.reason(verdict, r"repeat: cam1: stereo pairs ([\d.]+) ms apart .*, in which the board moves by ([\d.]+) px")
        self.assertAlmostEqual(delay, 15.0, delta=1.0)
        self.assertGreater(motion, 1.0)

    def test_cameras_that_share_few_views(self):
        everything = messages(self.rig)
        times = sorted({time for _, _, time in everything})
        kept = [(topic, image, time) for topic, image, time in everything
                if times.index(time) < 3 or ("cam0" in topic) == (times.index(time) % 2 == 0)]
        verdict = self.verdict(self.written("alone", kept), ["ds-none", "ds-none"], self.recordings.target("rig"))
        shared, = self.reason(verdict, r"usable: cam1 shares only (\d+) views")
        self.assertEqual(shared, 3)


if __name__ == "__main__":
    unittest.main()
