"""Rendered recordings, whose truth is known."""

import re
import subprocess

import numpy as np

from benchmarks.common import (WORK, calibrate, camera, difference, no_rounds, read_corners, rendered, rms, run, table,
                               test_program, write_corners)
from benchmarks.detectors import RECORDINGS, ours
from benchmarks.truth import Score, Truth


def sample(_):
    """The demo's recording: two 190-degree cameras, 60 views of 1000x800, rendered with truth."""
    bag, target, truth = rendered("sample", "--preset", "sample")
    models, topics = ["ds-none"] * 2, ["/cam0/image_raw", "/cam1/image_raw"]
    rows = []
    for label, flags in no_rounds("sample"):
        _, record, seconds = calibrate(WORK / "sample", bag, target, models, topics, *flags)
        text, _ = run("compare_calibrations", WORK / "sample-camchain.yaml", truth)
        errors = ", ".join(f"{float(value):.4f}" for value in re.findall(r"differs by ([0-9.]+) px rms", text))
        place = re.search(r"place differs by ([0-9.]+) mrad and ([0-9.]+) mm", text)
        rows.append([label, f"{camera(record, 0)['corners']['used']}, {camera(record, 1)['corners']['used']}",
                     f"{rms(record, 0):.4f}, {rms(record, 1):.4f}", errors, f"{place.group(1)}, {place.group(2)}", f"{seconds:.1f}"])
    table(["", "corners", "rms [px]", "true error of the projection to 90 degrees, rms [px]",
           "true error of the extrinsics [mrad], [mm]", "whole run [s]"], rows)


def wide(_):
    """195-degree lens at 1224x1024, 100 views, a third blurred by motion, 30 % with a hand: round 0 and the rounds."""
    recording = RECORDINGS[0]
    truth = Truth(recording)
    rows = []
    for label, key, flags in [("round 0", "round0", ["--max-rounds", "0"]), ("all rounds", "rounds", [])]:
        found = ours(recording, key, *flags)
        score = Score(truth, found.corners)
        errors = score.found_error_px
        total = np.sum(truth.asked)
        rows.append([f"{recording.name}, {label}", f"{np.sum(score.found)} of {total} ({100.0 * np.sum(score.found) / total:.1f} %)",
                     f"{score.num_false} ({100.0 * score.false_ratio:.2f} %)",
                     f"{np.median(errors):.4f}, {np.sqrt(np.mean(np.square(errors))):.4f}", f"{rms(found.record):.4f}",
                     difference(found.camchain, recording.files[2], "--max-angle-deg", 95), f"{found.wall_s:.1f}"])
    table(["", "visible corners found", "hidden, absent or > 2 px off", "error median, rms [px]", "residuals rms [px]",
           "true error of the model to 95 degrees, rms [px]", "whole run [s]"], rows)


def solver(_):
    """The joint solve of 500 views on one core: true corners of rendered views with noise of 0.1 px per axis (seed 1)."""
    rows = []
    for cameras in [1, 4]:
        name = f"solver{cameras}"
        bag, target, _ = rendered(name, "--lens", "fisheye190", "--resolution", "500x400", "--views", 500, "--cameras", cameras,
                                  "--baseline", 0.05)
        bag.unlink(missing_ok=True)  # only its corners are needed
        comments, corners = read_corners(WORK / f"{name}-truth-corners.csv")
        noise = np.random.default_rng(1).normal(0.0, 0.1, (len(corners), 2))
        for row, (du, dv) in zip(corners, noise):
            row.update(u_px=f"{float(row['u_px']) + du:.6f}", v_px=f"{float(row['v_px']) + dv:.6f}", cov_uu=0.01, cov_uv=0,
                       cov_vv=0.01, used=1)
        write_corners(WORK / f"{name}.csv", comments, corners)
        for which in ["schur", "sparse"]:
            text, _ = run("calibrate_cameras", "--no-report", "--corners", WORK / f"{name}.csv", "--target", target, "--models",
                          *["ds-none"] * cameras, "--threads", 1, "--linear-solver", which, "--verbose")
            start = sum(float(value) for value in re.findall(r"([0-9.]+) s  start camera", text))
            rows.append([f"{cameras}, {which}", len(corners), f"{start:.2f}", re.search(r"([0-9.]+) s  solve", text).group(1)])
    table(["cameras, linear solver", "corners", "starts [s]", "joint solve [s], asked < 0.5 and < 2"], rows)


def starts(_):
    """Starts without any guess: 200 simulated recordings per condition, lenses of 60 to 260 degrees, 20 pairs of models."""
    test = test_program("calibration_test")
    if test is None:
        print("skipped: the tests are not built; run scripts/test first\n")
        return
    done = subprocess.run([test, "--gtest_also_run_disabled_tests", "--gtest_filter=*DISABLED_succeeds_200_times*"],
                          stdout=subprocess.PIPE, text=True, check=False)
    table(["condition", "explained, of 200"], re.findall(r"^(.*): ([0-9]+)/200", done.stdout, re.MULTILINE))


EXPERIMENTS = {
    "sample": (sample, ""),
    "wide": (wide, ""),
    "solver": (solver, ""),
    "starts": (starts, ""),
}
