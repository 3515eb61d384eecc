"""Runs the built programs as a user does; shared by the tests of this folder."""

import os
import signal
import socket
import subprocess
import tempfile
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[2]
DEVEL = Path(os.environ.get("TARTAN_CALIB_DEVEL", SOURCE / "build/ws/devel"))
PROGRAMS = DEVEL / "lib" / "tartan_calib"

# More than any call here takes under load; a program that waits for something fails instead of hanging.
TIMEOUT_S = 240


def run(program, *arguments, **options):
    """The finished process of one of the package's programs, with its output as text."""
    return run_command(PROGRAMS / program, *arguments, **options)


def run_command(*words, **options):
    words = [str(word) for word in words]
    return subprocess.run(words, stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=TIMEOUT_S, **options)


def run_in_workspace(command, setup=DEVEL / "setup.bash", **options):
    """A shell command where `source <setup>` came before it."""
    return run_command("bash", "-c", f"source '{setup}' && {command}", **options)


def interrupt_after(line, program, *arguments):
    """Starts a program, sends it Ctrl-C once it printed `line`, and returns (exit code, whole output)."""
    words = [str(word) for word in (PROGRAMS / program, *arguments)]
    with subprocess.Popen(words, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True) as process:
        output = ""
        for text in process.stdout:
            output += text
            if line in text:
                process.send_signal(signal.SIGINT)
        return process.wait(timeout=TIMEOUT_S), output


def free_port():
    """Of this machine, for a ROS master of the test's own."""
    with socket.socket() as probe:
        probe.bind(("localhost", 0))
        return probe.getsockname()[1]


class Recordings:
    """Small recordings in a folder of their own, rendered once per test class."""

    def __init__(self):
        self._folder = tempfile.TemporaryDirectory(prefix="tartan_calib_")
        self.path = Path(self._folder.name)

    def remove(self):
        self._folder.cleanup()

    def simulate(self, name, *arguments):
        """Renders <name>.bag and its truth; returns the bag."""
        bag = self.path / f"{name}.bag"
        finished = run("simulate", "--output-bag", bag, *arguments)
        assert finished.returncode == 0, finished.stderr
        return bag

    def target(self, name):
        return self.path / f"{name}-target.yaml"


def calibrate(bag, target, models, topics=None, extra=(), report=False):
    extra = [*extra] if report else [*extra, "--no-report"]
    topics = topics or [f"/cam{index}/image_raw" for index in range(len(models))]
    return run("calibrate_cameras", "--bag", bag, "--target", target, "--topics", *topics, "--models", *models, *extra)
