"""The report's pages: no text on another, none beyond the page, the same scales for all cameras, however many there are."""

import itertools
import json
import os
import sys
import unittest
from unittest import mock

import numpy as np

from programs import PROGRAMS, SOURCE, Recordings, run_command

sys.path.insert(0, str(SOURCE / "scripts" / "report"))

import frame_pages  # noqa: E402  the folder comes first
import kalibr_pages  # noqa: E402
import matplotlib.pyplot as plt  # noqa: E402
import pdf_report  # noqa: E402
import quality_pages  # noqa: E402
from matplotlib.text import Text  # noqa: E402
from report_data import Report  # noqa: E402

KEEP_DATA = """import os, shutil, sys
shutil.copytree(sys.argv[1], os.environ["KEPT_DATA"])
raise ImportError("not drawn", name="matplotlib")
"""
TOLERANCE_PX = 1.0
REASON = "no corner beyond 61 degrees from the axis, where 37 % of the image lies (to 95 degrees): the edge is extrapolated"


def text_boxes(figure):
    """(text, extent) of all that is written on the page, as the renderer draws it; not in 3-D, where it is at any angle."""
    spatial = {text for axes in figure.axes if axes.name == "3d" for text in axes.findobj(Text)}
    with mock.patch.object(Text, "draw", autospec=True, side_effect=Text.draw) as draw:
        figure.canvas.draw()
    drawn = dict.fromkeys(call.args[0] for call in draw.call_args_list)
    return [(text.get_text(), text.get_window_extent()) for text in drawn if text.get_text().strip() and text not in spatial]


class PagesOfManyCameras(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.recordings = Recordings()
        cls.addClassCleanup(cls.recordings.remove)
        bag = cls.recordings.simulate("rig", "--cameras", 2, "--resolution", "320x256", "--views", 16, "--yaw", 8)
        modules = cls.recordings.path / "modules"
        modules.mkdir()
        (modules / "matplotlib.py").write_text(KEEP_DATA)
        cls.data = cls.recordings.path / "data"
        environment = {**os.environ, "PYTHONPATH": str(modules), "KEPT_DATA": str(cls.data)}
        finished = run_command(PROGRAMS / "calibrate_cameras", "--bag", bag, "--target", cls.recordings.target("rig"), "--models",
                               "ds-none", "ds-none", "--topics", "/cam0/image_raw", "/cam1/image_raw", env=environment)
        assert cls.data.exists(), finished.stdout + finished.stderr
        cls.description = json.loads((cls.data / "data.json").read_text())

    def tearDown(self):
        plt.close("all")
        (self.data / "data.json").write_text(json.dumps(self.description))

    def report(self, count=2, reasons=()):
        """The run's report as if it had `count` cameras, with reasons given for each."""
        cameras = [{**self.description["cameras"][index % 2], "name": f"cam{index}", "topic": f"/rig/camera_{index}/image_raw"}
                   for index in range(count)]
        shared = [[1000 + 10 * i + j for j in range(count)] for i in range(count)]
        facts = [f"cam{index}: corners to 95 degrees from the axis, rms 0.071 px" for index in range(count)]
        verdict = {"grade": "usable", "facts": facts,
                   "reasons": [{"grade": "usable", "text": f"cam{index}: {text}"} for index in range(count) for text in reasons]}
        (self.data / "data.json").write_text(json.dumps({**self.description, "cameras": cameras, "shared_corners": shared,
                                                         "verdict": verdict}))
        report = Report(self.data)
        for camera in report.cameras:  # some corners for the page of outliers
            camera.rejected = camera.found.where(np.arange(camera.found.size) % 40 == 0)
        return report

    def assert_readable(self, pages):
        count = 0
        for title, figure in pages:
            boxes = text_boxes(figure)
            page = figure.bbox
            for text, box in boxes:
                self.assertTrue(page.x0 <= box.x0 and box.x1 <= page.x1 and page.y0 <= box.y0 and box.y1 <= page.y1,
                                f"'{text}' is beyond the page '{title}': {box} in {page}")
            for (text, box), (other_text, other) in itertools.combinations(boxes, 2):
                width = min(box.x1, other.x1) - max(box.x0, other.x0)
                height = min(box.y1, other.y1) - max(box.y0, other.y0)
                self.assertFalse(width > TOLERANCE_PX and height > TOLERANCE_PX, f"'{text}' on '{other_text}' in '{title}'")
            plt.close(figure)
            count += 1
        return count

    def test_all_pages_of_two_cameras_are_readable(self):
        self.assertGreater(self.assert_readable(pdf_report.pages(self.report())), 20)

    def test_pages_that_all_cameras_share_are_readable(self):
        for count in (4, 8):
            report = self.report(count)
            for pages in (kalibr_pages.graph_page, kalibr_pages.outliers_pages, quality_pages.curves_page):
                self.assert_readable(pages(report))

    def test_verdict_goes_on_where_it_does_not_fit(self):
        for cameras, reasons, pages in ((1, 1, 1), (2, 4, 1), (4, 4, 2), (8, 2, 2), (8, 8, 6)):
            report = self.report(cameras, [f"{REASON} ({number})" for number in range(reasons)])
            drawn = list(frame_pages.verdict_page(report))
            self.assertEqual(len(drawn), pages)
            written = [text for _, figure in drawn for text, _ in text_boxes(figure)]
            self.assertEqual(sum(text.startswith("usable: cam") for text in written), cameras * reasons)
            self.assertEqual(written.count("model"), 1)
            self.assert_readable(drawn)

    def test_camera_that_lost_all_its_corners_costs_no_page(self):
        report = self.report()
        camera = report.cameras[0]
        camera.found = camera.used = camera.rejected = camera.found.where(np.array([], dtype=int))
        camera.curve.angle_deg, camera.curve.radius_px = np.zeros(1), np.zeros(1)
        camera.statistics = {**camera.statistics, "views": 0, "corners": 0, "bands": []}
        camera.radial_biases, camera.frames, camera.worst = [], [], []
        camera.max_polar_deg = camera.reach_deg = 0.0
        camera.median_difference_px = None
        self.assertGreater(self.assert_readable(pdf_report.pages(report)), 15)

    def limits(self, page_of, report, axes_index, which):
        """Of one of the axes, on this page of every camera."""
        found = []
        for camera in report.cameras:
            (_, figure), = page_of(report, camera)
            found.append(getattr(figure.axes[axes_index], f"get_{which}")())
            plt.close(figure)
        return found

    def test_cameras_have_the_same_scales(self):
        report = self.report()
        first, second = report.cameras
        second.used.du_px = 3.0 * second.used.du_px
        second.found = second.found.where(second.found.polar_deg < 60.0)
        first.radial_biases = [{"from_deg": 0.0, "to_deg": 10.0, "mean_px": -0.5, "stdev_px": 0.1}]
        polar = lambda *arguments: kalibr_pages.error_over_angle(*arguments, "polar")
        for page_of, axes_index, which in ((frame_pages.rounds_page, 1, "ylim"), (frame_pages.rounds_page, 1, "xlim"),
                                           (quality_pages.rms_page, 0, "ylim"), (quality_pages.rms_page, 1, "ylim"),
                                           (quality_pages.coverage_page, 2, "ylim"), (quality_pages.histogram_page, 0, "xlim"),
                                           (polar, 0, "ylim"), (polar, 1, "ylim"), (kalibr_pages.reprojection_page, 1, "xlim")):
            one, other = self.limits(page_of, report, axes_index, which)
            self.assertEqual(one, other, f"{page_of.__name__}, {which} of axes {axes_index}")
        times = []
        for camera in report.cameras:
            (_, figure), = frame_pages.worst_page(report, camera)
            times.append(next(text.get_text() for text in figure.texts if " times as long" in text.get_text()))
        self.assertEqual(*times)

    def test_page_of_vectors_says_which_corners_it_draws(self):
        report = self.report()
        for most, words in ((10 ** 6, "all corners"), (report.cameras[0].used.size // 3, "every 3rd corner")):
            with mock.patch.object(quality_pages, "MAX_ARROWS", most):
                (_, figure), = quality_pages.vectors_page(report, report.cameras[0])
            self.assertEqual(figure.axes[0].get_title(loc="left").split(",")[0], words)
        self.assertEqual([quality_pages.ordinal(number) for number in (2, 4, 11, 22, 113)], ["2nd", "4th", "11th", "22nd", "113th"])

    def test_one_wild_corner_leaves_the_others_their_scale(self):
        report = self.report()
        before = kalibr_pages.error_limit(report)
        report.cameras[0].used.du_px[0] = 1000.0
        self.assertLess(kalibr_pages.error_limit(report), 2.0 * before)
        (_, figure), = kalibr_pages.reprojection_page(report, report.cameras[0])
        self.assertRegex(figure.axes[1].get_title(), r"^\d+ of \d+ corners are beyond the scale$")


if __name__ == "__main__":
    unittest.main()
