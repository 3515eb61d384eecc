"""The report is written beside the other files, holds what it should, and never costs a result."""

import html
import os
import re
import shutil
import unittest
from pathlib import Path

import yaml

from programs import PROGRAMS, Recordings, assert_stopped, calibrate, interrupt_after, run_command, start, start_on_terminal

MODELS = ["ds-none", "ds-none"]
KALIBR_PAGES = ["Inter-camera observations graph", "camera system", "cam0: estimated poses", "cam0: polar error",
                "cam0: azimuthal error", "cam0: reprojection errors", "cam1: polar error"]
OWN_PAGES = ["cam0: coverage", "cam0: residual vectors", "cam0: residual histogram", "cam0: rms by polar angle and by view",
             "Distortion curves", "cam0: expected projection uncertainty", "Rig and boards", "frames with the largest residuals"]


class ReportOfARig(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.recordings = Recordings()
        cls.addClassCleanup(cls.recordings.remove)
        cls.bag = cls.recordings.simulate("rig", "--cameras", 2, "--resolution", "320x256", "--views", 16, "--yaw", 8)
        cls.finished = calibrate(cls.bag, cls.recordings.target("rig"), MODELS, extra=["--export-poses"], report=True)
        cls.page = (cls.recordings.path / "rig-report-cam.html").read_text()

    def pdf_text(self):
        if shutil.which("pdftotext") is None:
            self.skipTest("no pdftotext (poppler-utils) to read the PDF with")
        return run_command("pdftotext", "-layout", self.recordings.path / "rig-report-cam.pdf", "-").stdout

    def test_says_where_it_is_and_what_the_verdict_is(self):
        self.assertEqual(self.finished.returncode, 0, self.finished.stderr)
        self.assertIn("Report written to", self.finished.stdout)
        self.assertRegex(self.finished.stdout, r"Verdict: (good|usable|repeat)")

    def test_the_poses_come_after_it_as_kalibrs_do(self):
        lines = ["All views have been processed.", "Calibration complete.", "Results written to:", "Generating result report...",
                 "  Report written to ", "Exporting poses...", "  Poses written to "]
        places = [self.finished.stdout.find("\n" + line) for line in lines]
        self.assertNotIn(-1, places, self.finished.stdout)
        self.assertEqual(places, sorted(places))

    def test_pdf_has_kalibrs_pages_in_order_and_then_ours(self):
        text = self.pdf_text()
        places = [text.find(title) for title in KALIBR_PAGES + OWN_PAGES]
        self.assertNotIn(-1, places, list(zip(KALIBR_PAGES + OWN_PAGES, places)))
        self.assertEqual(places[:len(KALIBR_PAGES)], sorted(places[:len(KALIBR_PAGES)]))
        self.assertLess(max(places[:len(KALIBR_PAGES)]), min(places[len(KALIBR_PAGES):]))

    def test_verdict_is_the_same_in_terminal_pdf_and_page(self):
        verdict = re.search(r"Verdict: \w+", self.finished.stdout).group()
        self.assertIn(verdict, self.pdf_text())
        self.assertIn(verdict, self.page)

    def test_pdf_and_page_have_the_same_table_of_the_cameras(self):
        table = re.search(r'<table id="summary">(.*?)</table>', self.page, re.DOTALL).group(1)
        headings = re.findall("<th>(.*?)</th>", table, re.DOTALL)
        rows = [re.findall("<td>(.*?)</td>", row) for row in re.findall("<tr>(<td>.*?)</tr>", table)]
        self.assertEqual([row[:2] for row in rows], [["cam0", "ds-none"], ["cam1", "ds-none"]])
        text = " ".join(self.pdf_text().split())
        for row in rows:
            self.assertEqual(len(row), len(headings))
            self.assertIn(html.unescape(" ".join(row)), text)
        record = yaml.safe_load((self.recordings.path / "rig-calibration.yaml").read_text())
        for index, row in enumerate(rows):
            self.assertEqual(row[headings.index("rms (px)")], f"{record['cameras'][f'cam{index}']['residuals']['rms_px']:.3f}")

    def test_page_needs_no_other_file(self):
        self.assertEqual(re.findall(r"""(?:src|href)=["']?(?!data:)[^"'>]+""", self.page), [])
        self.assertNotIn("http", re.sub(r"data:[^\"]*", "", self.page))
        self.assertNotIn("<!--", self.page.replace("<!DOCTYPE", ""))

    def test_nothing_else_is_left(self):
        names = {path.name for path in self.recordings.path.glob("rig-*") if "truth" not in path.name}
        self.assertEqual(names, {"rig-target.yaml", "rig-camchain.yaml", "rig-results-cam.txt", "rig-calibration.yaml",
                                 "rig-poses-cam0.csv", "rig-report-cam.pdf", "rig-report-cam.html"})

    def browser(self, script):
        """What the page's document is after `script` ran in headless Chromium."""
        chromium = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
        if chromium is None:
            self.skipTest("no Chromium to open the page in")
        page = self.recordings.path / "driven.html"
        page.write_text(self.page.replace("</body>", f"<script>{script}</script></body>"))
        finished = run_command(chromium, "--headless", "--no-sandbox", "--disable-gpu", "--virtual-time-budget=5000",
                               "--dump-dom", page.as_uri())
        self.assertEqual(finished.returncode, 0, finished.stderr)
        return finished.stdout

    def test_table_sorts_and_a_row_shows_its_frame(self):
        document = self.browser("""
            const heading = document.querySelectorAll("#views th")[6];
            heading.click(); heading.click();
            const rows = [...document.querySelectorAll("#views tbody tr")];
            rows[0].click();
            setTimeout(() => {
              const values = rows.map(row => Number(row.cells[6].textContent));
              const sorted = values.every((value, i) => i === 0 || values[i - 1] >= value);
              const shown = document.getElementById("frame").dataset.shown;
              const key = rows[0].cells[0].textContent + "/" + rows[0].cells[1].textContent;
              document.title = `rows ${rows.length} sorted ${sorted} shown ${shown === key}`;
            }, 1000);""")
        title = re.search(r"<title>(.*)</title>", document).group(1)
        self.assertRegex(title, r"rows \d+ sorted true shown true")

    def test_slider_goes_through_all_frames_with_their_pictures(self):
        document = self.browser("""
            const pixels = () => { const c = document.getElementById("frame");
              const d = c.getContext("2d").getImageData(0, 0, c.width, c.height).data;
              let sum = 0; for (let i = 0; i < d.length; i += 997) { sum += d[i]; } return sum; };
            slider.value = 0; slider.oninput();
            setTimeout(() => { const first = pixels(); slider.value = slider.max; slider.oninput();
              setTimeout(() => { document.title = `frames ${Number(slider.max) + 1} differ ${pixels() !== first}`; }, 500); }, 500);""")
        title = re.search(r"<title>(.*)</title>", document).group(1)
        self.assertEqual(title, "frames 16 differ true")


VIEWS = 10


class ReportThatCannotBeDrawn(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.recordings = Recordings()
        cls.addClassCleanup(cls.recordings.remove)
        cls.bag = cls.recordings.simulate("one", "--resolution", "320x256", "--views", VIEWS)

    def calibrate(self, **environment):
        words = [PROGRAMS / "calibrate_cameras", "--bag", self.bag, "--target", self.recordings.target("one"), "--topics",
                 "/cam0/image_raw", "--models", "ds-none"]
        return run_command(*words, env={**os.environ, **environment})

    def reports(self):
        return list(self.recordings.path.glob("*-report-cam.*"))

    def test_without_matplotlib_there_is_a_warning_and_a_result(self):
        modules = self.recordings.path / "modules"
        modules.mkdir()
        (modules / "matplotlib.py").write_text("raise ImportError('none here', name='matplotlib')\n")
        finished = self.calibrate(PYTHONPATH=str(modules))
        self.assertEqual(finished.returncode, 0, finished.stderr)
        self.assertRegex(finished.stdout, r"WARN.*no report.*matplotlib")
        self.assertIn("Verdict:", finished.stdout)
        self.assertTrue((self.recordings.path / "one-camchain.yaml").exists())
        self.assertEqual(self.reports(), [])

    def test_without_a_temporary_folder_there_is_a_warning_and_a_result(self):
        finished = self.calibrate(TMPDIR="/nowhere")
        self.assertEqual(finished.returncode, 0, finished.stderr)
        self.assertRegex(finished.stdout, r"WARN.*no report")

    def test_terminal_shows_for_how_long_it_is_drawn(self):
        modules = self.recordings.path / "slow"
        modules.mkdir()
        (modules / "matplotlib.py").write_text("import time\ntime.sleep(3)\nraise ImportError('slow', name='matplotlib')\n")
        words = [PROGRAMS / "calibrate_cameras", "--bag", self.bag, "--target", self.recordings.target("one"), "--topics",
                 "/cam0/image_raw", "--models", "ds-none"]
        finished = run_command("script", "--quiet", "--return", "--command", " ".join(map(str, words)), "/dev/null",
                               env={**os.environ, "PYTHONPATH": str(modules)})
        self.assertEqual(finished.returncode, 0, finished.stdout)
        self.assertIn("Drawing the report: 2s", finished.stdout)

    def test_terminal_shows_a_bar_with_the_time_left(self):
        process, terminal = start_on_terminal(self, "calibrate_cameras", "--bag", self.bag, "--target", self.recordings.target("one"),
                                              "--topics", "/cam0/image_raw", "--models", "ds-none", "--max-rounds", 0)
        shown = b""
        with process, process.stderr:
            while b"Report written" not in shown:
                shown += os.read(terminal, 4096)
        for file in self.reports():
            file.unlink()
        drawing = shown[shown.index(b"Generating result report"):]
        done = [tuple(map(int, pair)) for pair in re.findall(rb"Progress (\d+) / (\d+) \t Time remaining: \d", drawing)]
        parts = [pair for pair in done if pair[1] != VIEWS]
        self.assertGreater(len(parts), 3, shown)
        self.assertEqual(parts, sorted(parts))
        self.assertEqual(len({total for _, total in parts}), 1, parts)
        self.assertGreater(parts[-1][0], parts[-1][1] / 2, parts)

    def test_ctrl_c_while_it_is_drawn_keeps_the_result_and_leaves_nothing(self):
        scratch = self.recordings.path / "scratch"
        scratch.mkdir()
        words = ["calibrate_cameras", "--bag", self.bag, "--target", self.recordings.target("one"), "--topics", "/cam0/image_raw",
                 "--models", "ds-none", "--export-poses"]
        process = start(*words, env={**os.environ, "TMPDIR": str(scratch)})
        stopped = interrupt_after("Generating result report", process)
        assert_stopped(self, stopped, "stopped before the report was drawn; the results above are written and complete")
        self.assertIn("  Poses written to", stopped.output)
        self.assertTrue((self.recordings.path / "one-camchain.yaml").exists())
        self.assertEqual(self.reports() + list(Path(scratch).iterdir()), [])


if __name__ == "__main__":
    unittest.main()
