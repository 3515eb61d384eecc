"""What a run takes of the machine."""

import os
import shutil
import subprocess

from benchmarks.common import PROGRAMS, WORK, Failed, Stopwatch, read_corners, rendered, run, table

NUM_VIEWS = 60
NUM_IMAGES = 3000


def peak_mb(program, *arguments):
    """Largest resident memory of one run of a program of this package [MB]."""
    with (WORK / "log.txt").open("a") as log:
        process = subprocess.Popen([PROGRAMS / program, *map(str, arguments)], stdout=log, stderr=subprocess.STDOUT)
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.WEXITSTATUS(status) if os.WIFEXITED(status) else -os.WTERMSIG(status)
    if process.returncode != 0:
        raise Failed(f"{program} exited with {process.returncode}: see {WORK / 'log.txt'}")
    return usage.ru_maxrss / 1000.0


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
    """Time of the detector on one core, reading and decoding included, over the demo's recording."""
    bag, target, _ = rendered("sample", "--preset", "sample")
    arguments = ["--target", target, "--models", *["ds-none"] * 2, "--topics", "/cam0/image_raw", "/cam1/image_raw", "--threads", 1]
    with Stopwatch() as whole:
        run("calibrate_cameras", "--bag", bag, *arguments, "--max-rounds", 0, "--export-corners")
    with Stopwatch() as without_images:
        run("calibrate_cameras", "--corners", WORK / "sample-corners.csv", *arguments)
    comments, _ = read_corners(WORK / "sample-corners.csv")
    num_pixels = NUM_VIEWS * sum(int(width) * int(height) for _, _, width, height, _ in map(str.split, comments))
    seconds = whole.cpu_s - without_images.cpu_s
    table(["pixels", "processor time [s]", "per pixel [ns], asked <= 32", "at 1224x1024 [ms], asked <= 40"],
          [[num_pixels, f"{seconds:.2f}", f"{1e9 * seconds / num_pixels:.1f}", f"{1e3 * seconds / num_pixels * 1224 * 1024:.1f}"]])


EXPERIMENTS = {"memory": (memory, ""), "detector": (detector, "")}
