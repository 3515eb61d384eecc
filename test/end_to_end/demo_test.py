"""The first command of README.md, where it was built by the project's own scripts: it ends well and prints what README.md shows."""

import re
import unittest

from programs import DEVEL, SOURCE, run_command

SAMPLE = SOURCE / "build/sample"


def without_numbers(line):
    return re.sub(r"\d+(\.\d+)?", "N", line.rstrip())


@unittest.skipUnless(DEVEL == SOURCE / "build/ws/devel", "another workspace than the one that scripts/demo builds")
class Demo(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.finished = run_command(SOURCE / "scripts/demo")

    def test_it_ends_well(self):
        self.assertEqual(self.finished.returncode, 0, self.finished.stdout + self.finished.stderr)

    def test_the_terminal_looks_as_the_readme_shows(self):
        """Line by line, but for the numbers."""
        shown = re.search(r"^```\n(.*?)^```$", (SOURCE / "README.md").read_text(), re.MULTILINE | re.DOTALL).group(1).splitlines()
        printed = {without_numbers(line) for line in self.finished.stdout.splitlines()}
        for line in shown:
            if line != "...":
                self.assertIn(without_numbers(line), printed)

    def test_it_names_the_files_that_there_are(self):
        named = self.finished.stdout.split("== Files\n")[1].split()
        for name in ("sample-camchain.yaml", "sample-results-cam.txt", "sample-report-cam.html", "sample-report-cam.pdf"):
            self.assertIn(str(SAMPLE / name), named)
            self.assertGreater((SAMPLE / name).stat().st_size, 0)

    def test_the_result_is_the_truth(self):
        differences = re.findall(r"projection to [\d.]+ degrees: differs by ([\d.]+) px rms", self.finished.stdout)
        self.assertEqual(len(differences), 2, self.finished.stdout)
        for difference_px in differences:
            self.assertLess(float(difference_px), 0.01)


if __name__ == "__main__":
    unittest.main()
