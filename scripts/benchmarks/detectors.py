"""Corners that detectors find in a rendered recording: other people's, each a process of its own, and ours by its flags."""

import dataclasses
import functools
import pathlib
import re
import sys

from benchmarks.common import Failed, Stopwatch, calibrate, rendered, run, test_program

SCRIPTS = pathlib.Path(__file__).resolve().parent


@dataclasses.dataclass(frozen=True)
class Recording:
    """A preset of simulate with one camera."""

    name: str
    title: str
    edge_deg: float  # half the angle of view

    @property
    def files(self):
        """Bag, target and true camchain; rendered where they do not exist yet."""
        return rendered(self.name, "--preset", self.name)


RECORDINGS = [Recording("bf5m", "lens like the Lensagon BF5M, 195 degrees, 1224x1024", 97.5),
              Recording("gopro", "lens like the GoPro's, 150 degrees, 1280x960", 75.0)]


@dataclasses.dataclass(frozen=True)
class Detection:
    """What one detector made of one recording."""

    corners: pathlib.Path
    cpu_s: float  # of other detectors' detection; of ours from the start of the program to its end
    wall_s: float
    median_ms: float = float("nan")  # detection in one frame; ours does not tell
    record: dict = None  # our calibration
    camchain: pathlib.Path = None


def peer(recording, key, program, *flags):
    """Runs a detector that prints its own processor time: reading the bag is not what is compared."""
    bag, target, _ = recording.files
    corners = bag.with_name(f"{recording.name}-{key}-corners.csv")
    with Stopwatch() as watch:
        text, _ = run(program, *flags, bag, target, corners)
    median_ms, sum_s = (float(re.search(rf"{what} ([0-9.e+-]+)", text).group(1)) for what in ("median", "sum"))
    return Detection(corners, sum_s, watch.wall_s, median_ms)


def apriltag(recording, key, *flags):
    program = test_program("detect_apriltag")
    if program is None:
        raise Failed("detect_apriltag is not built: run scripts/test first")
    return peer(recording, key, program, *flags)


def aruco(recording, key):
    return peer(recording, key, sys.executable, SCRIPTS / "detect_aruco.py")


@functools.lru_cache(maxsize=None)
def ours(recording, key, *flags, model="ds-none"):
    """Calibrates under a name of its own, so that the files of all choices of flags are there side by side."""
    bag, target, _ = recording.files
    link = bag.with_name(f"{recording.name}-{key}.bag")
    link.unlink(missing_ok=True)
    link.symlink_to(bag.name)
    with Stopwatch() as watch:
        _, record, _ = calibrate(link.with_suffix(""), link, target, [model], ["/cam0/image_raw"], "--export-corners", *flags)
    base = link.with_suffix("")
    return Detection(base.with_name(f"{base.name}-corners.csv"), watch.cpu_s, watch.wall_s, record=record,
                     camchain=base.with_name(f"{base.name}-camchain.yaml"))


@functools.lru_cache(maxsize=None)
def has_flag(flag):
    text, _ = run("calibrate_cameras", "--help")
    return flag in text


@dataclasses.dataclass(frozen=True)
class Detector:
    key: str
    title: str
    find: object  # function of recording and key
    needs_flag: str = ""

    @functools.lru_cache(maxsize=None)
    def __call__(self, recording):
        return self.find(recording, self.key)


def our_detector(key, title, *flags, needs_flag=""):
    return Detector(key, title, lambda recording, key: ours(recording, key, *flags), needs_flag)


PEERS = [
    Detector("apriltag", "libapriltag, as it comes", apriltag),
    Detector("apriltag2", "libapriltag, family with two border cells",
             lambda recording, key: apriltag(recording, key, "--border-cells", 2)),
    Detector("aruco", "OpenCV ArUco, two border cells", aruco),
]
OURS = [
    our_detector("round0", "round 0", "--max-rounds", "0"),
    our_detector("cube", "round 0 and the faces of a cube", "--max-rounds", "0", "--projections", "cube",
                 needs_flag="--projections"),
    our_detector("quads", "all rounds, filter `quads`", "--corner-filter", "quads", needs_flag="--corner-filter"),
    our_detector("rounds", "all rounds"),
]


def available():
    return [detector for detector in [*PEERS, *OURS] if not detector.needs_flag or has_flag(detector.needs_flag)]
