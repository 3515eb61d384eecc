"""Runs the built programs as a user does; shared by the tests of this folder."""

import os
import select
import signal
import socket
import subprocess
import tempfile
import time
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


def start(program, *arguments, **options):
    """A running program of the package; its standard error comes with its output."""
    words = [str(word) for word in (PROGRAMS / program, *arguments)]
    return subprocess.Popen(words, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, **options)


def start_on_terminal(test, program, *arguments):
    """The same with a terminal for its output, of which the other end comes with it; its standard error is a pipe."""
    terminal, its_end = os.openpty()
    test.addCleanup(os.close, terminal)
    words = [str(word) for word in (PROGRAMS / program, *arguments)]
    process = subprocess.Popen(words, stdin=subprocess.DEVNULL, stdout=its_end, stderr=subprocess.PIPE, text=True)
    os.close(its_end)
    return process, terminal


def shows_bar(terminal):
    """Whether the program has drawn its bar since the last call."""
    try:
        return select.select([terminal], [], [], 0)[0] and b"Time remaining" in os.read(terminal, 4096)
    except OSError:  # the program has ended
        return False


class Interrupted:
    """What a process did that got Ctrl-C: its exit code, whole output, and how long it took to end."""

    def __init__(self, process, output_before=""):
        sent_s = time.monotonic()
        process.send_signal(signal.SIGINT)
        with process.stdout or process.stderr as pipe:
            self.output = output_before + pipe.read()
        self.returncode = process.wait(timeout=TIMEOUT_S)
        self.seconds = time.monotonic() - sent_s


def interrupt_after(line, process):
    """Sends Ctrl-C to a process once it printed `line`."""
    output = ""
    while line not in output:
        text = process.stdout.readline()
        assert text, f"it ended without '{line}':\n{output}"
        output += text
    return Interrupted(process, output)


def interrupt_when(is_time, process):
    """Sends Ctrl-C to a process once `is_time()`."""
    while not is_time():
        assert process.poll() is None, f"it ended too early:\n{process.communicate()}"
    return Interrupted(process)


def assert_stopped(test, interrupted, finished, returncode=130):
    """It ended within a second, with that exit code and a line that says `finished`."""
    test.assertEqual(interrupted.returncode, returncode, interrupted.output)
    test.assertLess(interrupted.seconds, 1.0, interrupted.output)
    lines = [line for line in interrupted.output.splitlines() if "[ WARN]" in line]
    test.assertTrue(any(finished in line for line in lines), interrupted.output)
    if returncode != 0:
        test.assertIn("Shutdown requested! (CTRL+C)", interrupted.output)


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
