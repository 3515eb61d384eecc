"""Commands of README.md and docs run as they are written there; what they name exists."""

import functools
import os
import re
import shutil
import unittest
from pathlib import Path

from programs import PROGRAMS, SOURCE, Recordings, run, run_command, run_in_workspace

PAGES = [SOURCE / "README.md", *sorted((SOURCE / "docs").glob("*.md"))]

COMMAND = re.compile(r"(scripts/|\.ci/|ros|rqt|rviz|catkin_|cmake |ctest |source |export |cd |sudo |apt)")
BLOCK = re.compile(r"^```(?:sh|bash)?\n(.*?)^```$|((?:^ {4,}\S[^\n]*\n)+)", re.MULTILINE | re.DOTALL)
CODE = re.compile(r"`([^`\n]+)`")
FLAG = re.compile(r"(?<![\w-])--[A-Za-z][\w-]*\w")

# What a test cannot run, by how the command begins, and why.
NOT_RUN = {
    "scripts/build": "builds this package, which is what is tested here",
    "scripts/demo": "builds this package; demo_test.py runs it",
    "scripts/test": "runs this test",
    "source build/ws/devel/setup.bash": "is what every command of this test begins with",
    "cmake": "builds this package",
    "rosbag record": "needs cameras",
    "roslaunch tartan_calib record.launch": "needs cameras; launch_test.py and live_test.py run it",
    "roslaunch tartan_calib validate.launch": "needs cameras; launch_test.py and live_test.py run it",
    "rosservice": "needs a node that runs; live_test.py calls it",
}
# Flags of other programs.
FOREIGN_FLAGS = {"--build", "--gtest_filter", "--ros-args", "--test-dir"}


def code_blocks(page):
    for fenced, indented in BLOCK.findall(page.read_text()):
        yield re.sub(r"\s*\\\n\s*", " ", fenced or indented)


def commands(page):
    """Every command line of the page's blocks, without what a `#` says behind it."""
    for block in code_blocks(page):
        lines = [line.split("  #")[0].strip() for line in block.splitlines()]
        if lines and COMMAND.match(lines[0]):
            yield from filter(None, lines)


def reason_not_to_run(command):
    return next((reason for start, reason in NOT_RUN.items() if command.startswith(start)), None)


@functools.lru_cache(maxsize=None)  # the finished processes are only looked at
def run_as_written(command, folder):
    """In a folder with recordings, which is also the user's home; scripts are those of this repository."""
    command = re.sub(r"^(?=scripts/)", f"'{SOURCE}'/", command)
    return run_in_workspace(command, cwd=folder, env={**os.environ, "HOME": str(folder)})


class CommandsOfThePages(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        """The recordings, boards and calibrations that the pages speak of."""
        cls.recordings = Recordings()
        cls.addClassCleanup(cls.recordings.remove)
        folder = cls.recordings.path
        cls.recordings.simulate("rig", "--cameras", 2, "--views", 16, "--resolution", "400x320")
        shutil.copy(folder / "rig-target.yaml", folder / "april_6x6.yaml")
        (folder / "second.bag").symlink_to("rig.bag")
        for name in ("rig", "other", "second"):
            shutil.copy(folder / "rig-truth-camchain.yaml", folder / f"{name}-camchain.yaml")
        (folder / "my_ws/src").mkdir(parents=True)

    def test_there_are_commands(self):
        self.assertGreater(len(list(commands(PAGES[0]))), 6)

    def test_every_command_ends_well(self):
        for page in PAGES:
            for command in commands(page):
                if reason_not_to_run(command):
                    continue
                with self.subTest(page=page.name, command=command):
                    finished = run_as_written(command, self.recordings.path)
                    self.assertEqual(finished.returncode, 0, finished.stdout + finished.stderr)

    def test_what_is_not_run_stands_in_a_page(self):
        written = [command for page in PAGES for command in commands(page)]
        for start in NOT_RUN:
            self.assertTrue(any(command.startswith(start) for command in written), start)


class NamesInThePages(unittest.TestCase):
    def test_every_flag_is_known(self):
        known = FOREIGN_FLAGS.union(*(FLAG.findall(text) for text in self.helps()))
        for page in PAGES:
            for flag in FLAG.findall("\n".join([*CODE.findall(page.read_text()), *commands(page)])):
                self.assertIn(flag, known, page.name)

    def test_every_program_and_script_exists(self):
        for page in PAGES:
            for code in [*CODE.findall(page.read_text()), *commands(page)]:
                words = code.split()
                if words[:2] == ["rosrun", "tartan_calib"]:
                    self.assertTrue((PROGRAMS / words[2]).is_file(), f"{page.name}: {code}")
                elif words and words[0].startswith(("scripts/", ".ci/", "config/", "launch/", "test/")):
                    self.assertTrue((SOURCE / words[0]).exists(), f"{page.name}: {code}")

    def test_every_experiment_is_known(self):
        for script in ("scripts/benchmark", "scripts/draw_docs"):
            known = {line.split()[0] for line in run_command(SOURCE / script, "--list").stdout.splitlines()} | {"paper"}
            for page in PAGES:
                for names in re.findall(rf"`{script}((?: [a-z0-9]+)+)`", page.read_text()):
                    self.assertLessEqual(set(names.split()), known, page.name)

    @staticmethod
    def helps():
        """What programs and scripts say of their flags."""
        for program in PROGRAMS.iterdir():
            if program.is_file() and not program.name.endswith("_node"):  # these take ROS parameters
                yield run(program, "--help").stdout
        for script in (SOURCE / "scripts").iterdir():
            if script.is_file():
                yield script.read_text()
        yield (SOURCE / "src/apps/tartan_calibrate/tartan_flags.cpp").read_text()


if __name__ == "__main__":
    unittest.main()
