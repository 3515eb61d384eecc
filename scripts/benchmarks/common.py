"""What the experiments share: the programs, tables, corner CSVs, and recordings made of folders or rendered."""

import csv
import dataclasses
import pathlib
import re
import resource
import subprocess
import time

import yaml

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
WORK = ROOT / "build" / "benchmark"
PROGRAMS = ROOT / "build" / "ws" / "devel" / "lib" / "tartan_calib"
CORNER_HEADER = "camera,stamp_ns,corner_id,u_px,v_px,cov_uu,cov_uv,cov_vv,used".split(",")


class Failed(Exception):
    """A program of ours ended with an error; the text is its last line."""


@dataclasses.dataclass
class Settings:
    """What the command line chooses; every experiment gets it."""

    data: pathlib.Path  # folder of the recordings that are not rendered
    peers: dict  # name of another detector -> its corner file


class Stopwatch:
    """with Stopwatch() as watch: ...; wall_s and, of the programs that ended meanwhile, the processor time cpu_s."""

    def __enter__(self):
        self._wall_s, self._cpu_s = time.monotonic(), self._children_s()
        return self

    def __exit__(self, *_):
        self.wall_s, self.cpu_s = time.monotonic() - self._wall_s, self._children_s() - self._cpu_s

    @staticmethod
    def _children_s():
        usage = resource.getrusage(resource.RUSAGE_CHILDREN)
        return usage.ru_utime + usage.ru_stime


def run(program, *arguments):
    """Runs a program of this package, or any by its path; returns its stdout and the seconds it took."""
    command = [str(PROGRAMS / program), *map(str, arguments)]
    with Stopwatch() as watch:
        done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
    (WORK / "log.txt").open("a").write("$ " + " ".join(command) + "\n" + done.stdout + "\n")
    if done.returncode != 0:
        lines = [line for line in done.stdout.splitlines() if line.strip()] or ["no output"]
        raise Failed(f"{program} exited with {done.returncode}: {lines[-1]}")
    return done.stdout, watch.wall_s


def test_program(name):
    """Path of a program that is built with the tests; None where they are not built."""
    return next((ROOT / "build" / "ws" / "build").rglob(f"test/{name}"), None)


def calibrate(output, source, target, models, topics, *flags):
    """Calibrates a bag, folder or (--corners) CSV; returns the parsed camchain and calibration record, and seconds."""
    if pathlib.Path(source).suffix == ".csv":
        where = ["--corners", source]
    else:
        where = ["--bag", source]
    arguments = [*where, "--target", target, "--models", *models, "--topics", *topics, "--no-report", *flags]
    _, seconds = run("calibrate_cameras", *arguments)
    chain = yaml.safe_load(pathlib.Path(f"{output}-camchain.yaml").read_text())
    record = yaml.safe_load(pathlib.Path(f"{output}-calibration.yaml").read_text())
    return chain, record, seconds


def table(header, rows):
    print("| " + " | ".join(header) + " |")
    print("|" + "---|" * len(header))
    for row in rows:
        print("| " + " | ".join(str(value) for value in row) + " |")
    print()


def percent(value, reference):
    return f"{100.0 * (value / reference - 1.0):+.2f} %"


def write_corners(path, comments, rows):
    """Corner CSV in the tool's own format; rows are dictionaries with CORNER_HEADER's keys."""
    with path.open("w", newline="") as file:
        file.writelines(comment + "\n" for comment in comments)
        writer = csv.DictWriter(file, CORNER_HEADER, lineterminator="\n", restval="")
        writer.writeheader()
        writer.writerows(rows)


def read_corners(path):
    lines = path.read_text().splitlines()
    comments = [line for line in lines if line.startswith("#")]
    return comments, list(csv.DictReader(line for line in lines if not line.startswith("#")))


def split_by_stamp(path, selected, rest, is_selected):
    """Splits a corner CSV into two by the index of the image's stamp among all stamps."""
    comments, rows = read_corners(path)
    order = {stamp: index for index, stamp in enumerate(sorted({int(row["stamp_ns"]) for row in rows}))}
    chosen = [row for row in rows if is_selected(order[int(row["stamp_ns"])])]
    others = [row for row in rows if not is_selected(order[int(row["stamp_ns"])])]
    write_corners(selected, comments, chosen)
    write_corners(rest, comments, others)


def linked_folder(name, images):
    """A folder in kalibr_bagcreater's layout with links to `images`; those whose names are no stamps get one."""
    folder = WORK / name / "cam0"
    folder.mkdir(parents=True, exist_ok=True)
    for index, image in enumerate(sorted(images.iterdir())):
        stamp = image.stem if image.stem.isdigit() else f"{2_000_000_000 + index}000000000"
        link = folder / f"{stamp}{image.suffix}"
        if not link.exists():
            link.symlink_to(image.resolve())
    return folder.parent


def no_rounds(name):
    """Round 0 alone, and with the rounds, as (label, flags)."""
    return [(f"{name}, round 0", ["--max-rounds", "0"]), (f"{name}, all rounds", [])]


def camera(record, index=0):
    return record["cameras"][f"cam{index}"]


def rms(record, index=0):
    return camera(record, index)["residuals"]["rms_px"]


def difference(*arguments):
    """Rms difference [px] that compare_calibrations finds for a single camera."""
    text, _ = run("compare_calibrations", *arguments)
    return f"{float(re.search(r'differs by ([0-9.]+) px rms', text).group(1)):.3f}"


def corners_per_image(path, used=True):
    _, rows = read_corners(path)
    counts = {}
    for row in rows:
        counts[row["stamp_ns"]] = counts.get(row["stamp_ns"], 0) + (int(row["used"]) if used else 1)
    return list(counts.values())


def rendered(name, *flags):
    """A rendered recording with its truth; made once."""
    bag = WORK / f"{name}.bag"
    if not (WORK / f"{name}-truth-visibility.csv").exists():
        run("simulate", *flags, "--output-bag", bag)
    return bag, WORK / f"{name}-target.yaml", WORK / f"{name}-truth-camchain.yaml"
