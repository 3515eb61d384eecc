#!/usr/bin/python3
"""Calibrates the EuRoC stereo rig from recorded corners and holds it against the published calibration.

Usage: scripts/benchmark_euroc.py DATA [PROGRAM]
DATA: folder with cam0.csv.gz, cam1.csv.gz and target.yaml. PROGRAM: calibrate_cameras, by default the one that scripts/build
made. Every fifth view is held out: the rest is calibrated from nothing, then only the poses of the held-out views are solved.
The exit code is 1 where a limit is missed.
"""

import gzip
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
import yaml

PROGRAM = Path(__file__).resolve().parent.parent / "build/ws/devel/lib/tartan_calib/calibrate_cameras"
WIDTH, HEIGHT = 752, 480
TAG_COLS = 6
HELD_OUT_EVERY = 5

# Burri et al. 2016, "The EuRoC micro aerial vehicle datasets": fu, fv, cu, cv and k1, k2, p1, p2.
PUBLISHED = [
    ([458.654, 457.296, 367.215, 248.375], [-0.28340811, 0.07395907, 0.00019359, 1.76187114e-05]),
    ([457.587, 456.134, 379.999, 255.238], [-0.28368365, 0.07451284, -0.00010473, -3.55590700e-05]),
]
PUBLISHED_BASELINE_M = 0.1101

MAX_FOCAL_ERROR = 0.005
MAX_BASELINE_ERROR_M = 0.001
MAX_HELD_OUT_RMS_PX = 0.55


def read_corners(data):
    """(camera, stamp, corner id in Kalibr's lattice, u, v), the pixels as text."""
    lattice_offset = [(0, 0), (0, 1), (1, 1), (1, 0)]  # of bottom-left, bottom-right, top-right, top-left
    for camera in range(2):
        with gzip.open(data / f"cam{camera}.csv.gz", "rt") as file:
            for line in file:
                if line.startswith("#"):
                    continue
                stamp, tag, corner, u, v = line.split(",")[:5]
                row, col = divmod(int(tag), TAG_COLS)
                d_row, d_col = lattice_offset[int(corner)]
                yield camera, int(stamp), (2 * row + d_row) * 2 * TAG_COLS + 2 * col + d_col, u, v


def write_corners(path, corners):
    with open(path, "w", encoding="ascii") as file:
        for camera in range(2):
            file.write(f"# cam{camera} {WIDTH} {HEIGHT} /cam{camera}/image_raw\n")
        file.write("camera,stamp_ns,corner_id,u_px,v_px,cov_uu,cov_uv,cov_vv,used\n")
        for corner in corners:
            file.write("%d,%d,%d,%s,%s,,,,\n" % corner)


def calibrate(program, corners_file, target, *flags):
    """The files camchain.yaml and calibration.yaml."""
    command = [str(program), "--corners", str(corners_file), "--target", str(target), *flags]
    run = subprocess.run(command, capture_output=True, text=True, check=False)
    if run.returncode != 0:
        sys.exit(f"{' '.join(command)}\n{run.stdout}{run.stderr}")
    prefix = str(corners_file).removesuffix("-corners.csv")
    return [yaml.safe_load(Path(prefix + name).read_text()) for name in ("-camchain.yaml", "-calibration.yaml")]


def distort(rays, intrinsics, distortion):
    x, y = rays[:, 0] / rays[:, 2], rays[:, 1] / rays[:, 2]
    k1, k2, p1, p2 = distortion
    r2 = x * x + y * y
    g = 1 + k1 * r2 + k2 * r2 * r2
    xd = x * g + 2 * p1 * x * y + p2 * (r2 + 2 * x * x)
    yd = y * g + 2 * p2 * x * y + p1 * (r2 + 2 * y * y)
    fu, fv, cu, cv = intrinsics
    return np.stack([fu * xd + cu, fv * yd + cv], axis=1)


def unproject(pixels, intrinsics, distortion):
    """By Newton steps with a numeric Jacobian, from the undistorted point."""
    fu, fv, cu, cv = intrinsics
    rays = np.stack([(pixels[:, 0] - cu) / fu, (pixels[:, 1] - cv) / fv, np.ones(len(pixels))], axis=1)
    step = 1e-6
    for _ in range(30):
        error = distort(rays, intrinsics, distortion) - pixels
        columns = [(distort(rays + step * axis, intrinsics, distortion) - pixels - error) / step for axis in np.eye(3)[:2]]
        rays[:, :2] -= np.linalg.solve(np.stack(columns, axis=2), error[:, :, None])[:, :, 0]
    return rays / np.linalg.norm(rays, axis=1, keepdims=True)


def rotate(phi, rays):
    angle = np.linalg.norm(phi)
    if angle == 0.0:
        return rays
    axis = phi / angle
    along = np.outer(rays @ axis, axis)
    return along + np.cos(angle) * (rays - along) + np.sin(angle) * np.cross(axis, rays)


def best_rotation(pixels, ours, published):
    """Steps of the rotation between the two camera frames, which the board poses take up: Gauss-Newton over the pixels."""
    rays = unproject(pixels, *ours)
    steps = []
    for _ in range(10):
        error = distort(rays, *published) - pixels
        moved = [distort(rays + 1e-6 * np.cross(axis, rays), *published) - pixels for axis in np.eye(3)]
        jacobian = np.stack([((m - error) / 1e-6).ravel() for m in moved], axis=1)
        steps.append(-np.linalg.lstsq(jacobian, error.ravel(), rcond=None)[0])
        rays = rotate(steps[-1], rays)
    return steps


def show_difference(camera, chain, corners):
    """How far apart the two calibrations send the same rays."""
    ours = chain[f"cam{camera}"]["intrinsics"], chain[f"cam{camera}"]["distortion_coeffs"]
    seen = np.array([(float(u), float(v)) for c, _, _, u, v in corners if c == camera])
    steps = best_rotation(seen, ours, PUBLISHED[camera])

    def difference(pixels):
        rays = unproject(pixels, *ours)
        for step in steps:
            rays = rotate(step, rays)
        return np.linalg.norm(distort(rays, *PUBLISHED[camera]) - pixels, axis=1)

    at_corners = difference(seen)
    print(f"cam{camera}: |published - ours| [px], rotation removed, at the corners: rms {np.sqrt(np.mean(at_corners ** 2)):.2f},"
          f" 95 % below {np.quantile(at_corners, 0.95):.2f}; over the image, in brackets where no corner is within 50 px:")
    u, v = np.meshgrid(np.linspace(0, WIDTH - 1, 9), np.linspace(0, HEIGHT - 1, 7))
    grid = np.stack([u.ravel(), v.ravel()], axis=1)
    is_seen = [np.min(np.linalg.norm(seen - pixel, axis=1)) < 50.0 for pixel in grid]
    texts = [f" {d:5.2f} " if near else f"({d:5.2f})" for d, near in zip(difference(grid), is_seen)]
    for row in range(u.shape[0]):
        print("   " + " ".join(texts[row * u.shape[1]:(row + 1) * u.shape[1]]))


def check(name, value, limit, unit):
    is_met = abs(value) <= limit
    print(f"{name:38s} {value:9.4f} {unit:3s} (limit {limit:g}) {'ok' if is_met else 'MISSED'}")
    return is_met


def main():
    if not 2 <= len(sys.argv) <= 3:
        sys.exit(__doc__)
    data = Path(sys.argv[1])
    program = Path(sys.argv[2]) if len(sys.argv) == 3 else PROGRAM
    target = data / "target.yaml"
    corners = list(read_corners(data))
    stamps = sorted({corner[1] for corner in corners})
    held_out = set(stamps[HELD_OUT_EVERY - 1::HELD_OUT_EVERY])

    with tempfile.TemporaryDirectory() as folder:
        train_file, test_file = Path(folder) / "train-corners.csv", Path(folder) / "test-corners.csv"
        write_corners(train_file, [corner for corner in corners if corner[1] not in held_out])
        write_corners(test_file, [corner for corner in corners if corner[1] in held_out])
        chain, train = calibrate(program, train_file, target, "--models", "pinhole-radtan", "pinhole-radtan")
        fixed = ("--init", str(Path(folder) / "train-camchain.yaml"), "--fix", "intrinsics", "--fix", "extrinsics")
        _, filtered = calibrate(program, test_file, target, *fixed)
        _, unfiltered = calibrate(program, test_file, target, *fixed, "--no-outliers-removal")

    both = sum(len({c[0] for c in corners if c[1] == stamp}) == 2 for stamp in stamps)
    print(f"{len(stamps)} views, {len(stamps) - both} of them of one camera only; {len(held_out)} held out")
    is_good = True
    for camera in range(2):
        intrinsics = chain[f"cam{camera}"]["intrinsics"]
        for k, name in enumerate(("fu", "fv")):
            error = 100.0 * (intrinsics[k] / PUBLISHED[camera][0][k] - 1.0)
            is_good &= check(f"cam{camera} {name}, difference", error, 100.0 * MAX_FOCAL_ERROR, "%")
    baseline = np.linalg.norm(np.array(chain["cam1"]["T_cn_cnm1"])[:3, 3])
    is_good &= check("baseline, difference", 1000.0 * (baseline - PUBLISHED_BASELINE_M), 1000.0 * MAX_BASELINE_ERROR_M, "mm")
    for camera in range(2):
        cam = f"cam{camera}"
        rms = filtered["cameras"][cam]["residuals"]["rms_px"]
        is_good &= check(f"{cam} held-out views, rms", rms, MAX_HELD_OUT_RMS_PX, "px")
        print(f"   with {filtered['cameras'][cam]['corners']['outliers']} outliers left in:"
              f" {unfiltered['cameras'][cam]['residuals']['rms_px']:.4f} px;"
              f" calibrated views: {train['cameras'][cam]['residuals']['rms_px']:.4f} px,"
              f" {train['cameras'][cam]['corners']['outliers']} outliers of"
              f" {train['cameras'][cam]['corners']['used'] + train['cameras'][cam]['corners']['outliers']} corners")
    for camera in range(2):
        show_difference(camera, chain, corners)
    sys.exit(0 if is_good else 1)


if __name__ == "__main__":
    main()
