"""Rendered recordings, whose truth is known."""

import re
import subprocess

import numpy as np

from benchmarks.common import ROOT, WORK, calibrate, camera, difference, no_rounds, read_corners, rendered, rms, run, table, write_corners


def sample(_):
    """The demo's recording: two 190-degree cameras, 60 views of 1000x800, rendered with truth."""
    bag, target, truth = rendered("sample", "--preset", "sample")
    models, topics = ["ds-none"] * 2, ["/cam0/image_raw", "/cam1/image_raw"]
    rows = []
    for label, flags in no_rounds("sample"):
        _, record, seconds = calibrate(WORK / "sample", bag, target, models, topics, *flags)
        text, _ = run("compare_camchains", WORK / "sample-camchain.yaml", truth)
        errors = ", ".join(f"{float(value):.4f}" for value in re.findall(r"differs by ([0-9.]+) px rms", text))
        place = re.search(r"place on the rig: differs by ([0-9.]+) mrad and ([0-9.]+) mm", text)
        rows.append([label, f"{camera(record, 0)['corners']['used']}, {camera(record, 1)['corners']['used']}",
                     f"{rms(record, 0):.4f}, {rms(record, 1):.4f}", errors, f"{place.group(1)}, {place.group(2)}", f"{seconds:.1f}"])
    table(["", "corners", "rms [px]", "true error of the projection to 90 degrees, rms [px]",
           "true error of the extrinsics [mrad], [mm]", "whole run [s]"], rows)


def wide(_):
    """195-degree lens at 1224x1024, 100 views, a third blurred by motion, 30 % with a hand: corners by polar angle."""
    bag, target, truth = rendered("bf5m", "--preset", "bf5m")
    _, visible = read_corners(WORK / "bf5m-truth-corners.csv")
    known = {(row["stamp_ns"], row["corner_id"]): row for row in visible}
    rows = []
    for label, flags in no_rounds("bf5m"):
        _, record, seconds = calibrate(WORK / "bf5m", bag, target, ["ds-none"], ["/cam0/image_raw"], "--export-corners", *flags)
        _, found = read_corners(WORK / "bf5m-corners.csv")
        wrong, errors = 0, []
        num_found = 0
        for row in found:
            true = known.get((row["stamp_ns"], row["corner_id"]))
            error = np.hypot(float(row["u_px"]) - float(true["u_px"]), float(row["v_px"]) - float(true["v_px"])) if true else 1e9
            if true is None or true["used"] == "0" or error > 2.0:
                wrong += 1
            else:
                num_found += 1
                errors.append(error)
        total = sum(row["used"] == "1" for row in visible)
        rows.append([label, f"{num_found} of {total} ({100.0 * num_found / total:.1f} %)", f"{wrong} ({100.0 * wrong / len(found):.2f} %)",
                     f"{np.median(errors):.4f}, {np.sqrt(np.mean(np.square(errors))):.4f}", f"{rms(record):.4f}",
                     difference(WORK / "bf5m-camchain.yaml", truth, "--max-angle-deg", 95), f"{seconds:.1f}"])
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
            text, _ = run("calibrate_cameras", "--corners", WORK / f"{name}.csv", "--target", target, "--models",
                          *["ds-none"] * cameras, "--threads", 1, "--linear-solver", which, "--verbose")
            start = sum(float(value) for value in re.findall(r"([0-9.]+) s  start camera", text))
            rows.append([f"{cameras}, {which}", len(corners), f"{start:.2f}", re.search(r"([0-9.]+) s  solve", text).group(1)])
    table(["cameras, linear solver", "corners", "starts [s]", "joint solve [s], asked < 0.5 and < 2"], rows)


def starts(_):
    """Starts without any guess: 200 simulated recordings per condition, lenses of 60 to 260 degrees, 20 pairs of models."""
    test = next((ROOT / "build" / "ws" / "build").rglob("calibration_test"), None)
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
