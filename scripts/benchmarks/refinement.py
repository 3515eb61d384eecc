"""Distance of refined corners to the truth: Table III of the TartanCalib paper, which could only compare with clicks."""

import dataclasses
import re

import numpy as np

from benchmarks.common import WORK, Failed, calibrate, read_corners, run, table, test_program
from benchmarks.detectors import RECORDINGS
from benchmarks.limits import is_blurred
from benchmarks.truth import BAND_DEG, MAX_ERROR_PX, Truth, bands

# Round 1 through the true lens, so that every method has the same predictions.
METHODS = [("fixed (Kalibr)", "fixed", ["--refinement", "fixed"]),
           ("adaptive (TartanCalib)", "adaptive", ["--refinement", "adaptive"]),
           ("symmetry, paper's window", "wide", ["--symmetry-window", "1.5"]),
           ("symmetry", "symmetry", [])]
WINDOWS = ["0.6", "0.75", "0.9", "1.0"]


@dataclasses.dataclass(frozen=True)
class Errors:
    """One row for each corner that is asked for; NaN where it was not found."""

    px: np.ndarray
    sigmas: np.ndarray  # in units of the stated covariance, one column for each of two axes


def refined(recording, truth, key, *flags):
    """Errors of the corners after one round with the true lens."""
    bag, target, lens = recording.files
    calibrate(bag.with_suffix(""), bag, target, ["ds-none"], ["/cam0/image_raw"], "--init", lens, "--fix", "intrinsics",
              "--max-rounds", "1", "--export-corners", *flags)
    corners = WORK / f"{recording.name}-refined-{key}-corners.csv"
    bag.with_name(f"{recording.name}-corners.csv").replace(corners)
    errors = np.full((len(truth.px), 2), np.nan)
    sigmas = errors.copy()
    for corner in read_corners(corners)[1]:
        row = truth.row_of.get((int(corner["stamp_ns"]), int(corner["corner_id"])))
        if row is None or not truth.asked[row]:
            continue
        errors[row] = np.array([float(corner["u_px"]), float(corner["v_px"])]) - truth.px[row]
        uu, uv, vv = (float(corner[name]) for name in ("cov_uu", "cov_uv", "cov_vv"))
        sigmas[row] = np.linalg.solve(np.linalg.cholesky([[uu, uv], [uv, vv]]), errors[row])
    return Errors(np.hypot(*errors.T)[truth.asked], sigmas[truth.asked])


def figures(errors, bound_px, chosen):
    """Median and rms of what is within 2 px, failures, and the median of |error| / sqrt(trace(bound))."""
    px = errors.px[chosen]
    right = px <= MAX_ERROR_PX
    if not right.any():
        return ["-"] * 5
    spread = np.abs(errors.sigmas[chosen][right])
    return [f"{np.median(px[right]):.4f}", f"{np.sqrt(np.mean(px[right] ** 2)):.4f}",
            f"{np.sum(~right)} of {len(px)}", f"{np.median((px / bound_px[chosen])[right]):.2f}",
            f"{np.sqrt(np.mean(spread[spread < 4] ** 2)):.2f}"]


COLUMNS = ["median [px]", "rms [px]", "missed or > 2 px off", "median error / bound", "stdev of normalised errors"]


def by_polar_angle(recording, truth, found):
    """One row for each method and figure, one column for each band."""
    polar_deg = truth.polar_deg[truth.asked]
    bound_px = truth.bound_px[truth.asked]
    ranges = bands(recording.edge_deg)
    rows = []
    for label, errors in found.items():
        columns = [figures(errors, bound_px, (polar_deg >= start) & (polar_deg < end)) for start, end in ranges]
        rows += [[label, name, *(value.split(" of ")[0] for value in values)] for name, values in zip(COLUMNS, zip(*columns))]
    table(["refinement", f"by {BAND_DEG} degrees of polar angle", *(f"{start}-{end}" for start, end in ranges)], rows)


def times(recording):
    """Processor time that each method needs for a corner, on one thread, around the corners that symmetry found."""
    program = test_program("time_refinement")
    if program is None:
        raise Failed("time_refinement is not built: run scripts/build tests first")
    bag, target, lens = recording.files
    text, _ = run(program, bag, WORK / f"{recording.name}-refined-symmetry-corners.csv", target, lens)
    found = re.findall(r"^(\w+) (\d+) corners ([0-9.]+) us$", text, re.MULTILINE)
    table(["refinement", "corners", "processor time of a corner [us], asked <= 60"],
          [[method, count, f"{float(time_us):.0f}"] for method, count, time_us in found])


def refinement(_):
    """Distance to the truth of refined corners (Table III): fixed, adaptive, symmetry in the paper's window and in ours."""
    recording = RECORDINGS[0]
    truth = Truth(recording)
    blurred = is_blurred(truth)[truth.asked]
    bound_px = truth.bound_px[truth.asked]
    parts = [("all", np.ones(len(bound_px), bool)), ("sharp", ~blurred), ("blurred by motion", blurred)]
    print(f"{recording.title}. Bound: sqrt(trace) of each corner's Cramer-Rao bound; the best estimate has the median 0.83.\n")
    found = {label: refined(recording, truth, key, *flags) for label, key, flags in METHODS}
    table(["refinement", "corners", *COLUMNS],
          [[label, part, *figures(errors, bound_px, chosen)] for label, errors in found.items() for part, chosen in parts])
    by_polar_angle(recording, truth, found)
    times(recording)
    rows = []
    for window in WINDOWS:
        errors = refined(recording, truth, f"window-{window}", "--symmetry-window", window)
        rows += [[window, part, *figures(errors, bound_px, chosen)] for part, chosen in parts]
    table(["half-width of symmetry's window", "corners", *COLUMNS], rows)


EXPERIMENTS = {"refinement": (refinement, "")}
