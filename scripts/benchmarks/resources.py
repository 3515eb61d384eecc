"""What a run takes of the machine."""

import re
import shutil
import subprocess
import sys

from benchmarks.common import PROGRAMS, WORK, Failed, Stopwatch, rendered, run, table, test_program

NUM_VIEWS = 60
NUM_IMAGES = 3000
NUM_CAMERAS = 4
NUM_REPEATS = 3  # the fastest run counts: whatever else the machine does only adds


# A process starts with the peak of the one that made it; this one is small.
WAIT_FOR = """
import os, subprocess, sys
process = subprocess.Popen(sys.argv[1:], stdout=sys.stderr)
_, status, usage = os.wait4(process.pid, 0)
print(usage.ru_maxrss)
sys.exit(os.WEXITSTATUS(status) if os.WIFEXITED(status) else 128 + os.WTERMSIG(status))
"""


def peak_mb(program, *arguments):
    """Largest resident memory of one run of a program of this package [MB]."""
    arguments = [sys.executable, "-c", WAIT_FOR, PROGRAMS / program, *map(str, arguments)]
    with (WORK / "log.txt").open("a") as log:
        waiter = subprocess.run(arguments, stdout=subprocess.PIPE, stderr=log, text=True, check=False)
    if waiter.returncode != 0:
        raise Failed(f"{program} exited with {waiter.returncode}: see {WORK / 'log.txt'}")
    return int(waiter.stdout) / 1000.0


def memory(_):
    """Peak memory for a bag of 3000 images of 1920x1080: 60 rendered views, 50 times each. Takes 7 GB of disk for a while."""
    views, folder, bag = WORK / "memory-views", WORK / "memory", WORK / "memory.bag"
    if not views.is_dir():
        run("simulate", "--output-dir", views, "--lens", "fisheye150", "--resolution", "1920x1080", "--views", NUM_VIEWS)
    shutil.rmtree(folder, ignore_errors=True)
    (folder / "cam0").mkdir(parents=True)
    files = sorted((views / "cam0").iterdir())
    for index in range(NUM_IMAGES):
        (folder / "cam0" / f"{10**18 + index * 10**8}.png").symlink_to(files[index % NUM_VIEWS])
    run("make_bag", "--folder", folder, "--output-bag", bag)
    shutil.rmtree(folder)
    arguments = ["--bag", bag, "--target", WORK / "memory-views-target.yaml", "--models", "ds-none", "--topics", "/cam0/image_raw"]
    try:
        rows = [[label, f"{peak_mb('calibrate_cameras', *arguments, *flags):.0f}"]
                for label, flags in [("100 of them", ["--bag-freq", 1.0 / 3.0]), ("all 3000", [])]]
    finally:
        bag.unlink()
    table(["images", "peak memory [MB], asked <= 500"], rows)


def detector(_):
    """Time of the detector on one core over the demo's recording."""
    program = test_program("time_detector")
    if program is None:
        raise Failed("time_detector is not built: run scripts/test first")
    bag, target, _ = rendered("sample", "--preset", "sample")
    text, _ = run(program, bag, target, "/cam0/image_raw", "/cam1/image_raw")
    num_images, median_ns, sum_s = (float(re.search(rf"{what} ([0-9.e+-]+)", text).group(1)) for what in ("images", "median", "sum"))
    table(["images", "processor time [s]", "per pixel, median [ns], asked <= 32", "at 1224x1024 [ms], asked <= 40"],
          [[f"{num_images:.0f}", f"{sum_s:.2f}", f"{median_ns:.1f}", f"{1e-6 * median_ns * 1224 * 1024:.1f}"]])


def report(_):
    """What the report adds to the time of a run: 500 views of four cameras, with the default rounds."""
    bag, target, _ = rendered("report", "--cameras", NUM_CAMERAS, "--views", 500, "--resolution", "320x256", "--yaw", 8)
    arguments = ["--bag", bag, "--target", target, "--models", *["ds-none"] * NUM_CAMERAS, "--topics",
                 *(f"/cam{index}/image_raw" for index in range(NUM_CAMERAS))]

    def fastest(*flags):
        times = []
        for _ in range(NUM_REPEATS):
            with Stopwatch() as watch:
                run("calibrate_cameras", *arguments, *flags)
            times.append((watch.wall_s, watch.cpu_s))
        return [min(column) for column in zip(*times)]

    without, whole = fastest("--no-report"), fastest()
    rows = [["without", *without], ["with", *whole], ["the report, asked <= 10", *(b - a for a, b in zip(without, whole))]]
    table(["run", "wall [s]", "processor [s]"], [[label, *(f"{seconds:.1f}" for seconds in times)] for label, *times in rows])


EXPERIMENTS = {"memory": (memory, ""), "detector": (detector, ""), "report": (report, "")}
