#!/usr/bin/python3
"""Prints two camchains side by side: parameters, and how far the extrinsics are apart.

Usage: scripts/compare_camchains.py <camchain.yaml> <truth.yaml>
"""

import math
import sys

import yaml

NAMES = {
    "pinhole": ["fu", "fv", "cu", "cv"],
    "omni": ["xi", "fu", "fv", "cu", "cv"],
    "eucm": ["alpha", "beta", "fu", "fv", "cu", "cv"],
    "ds": ["xi", "alpha", "fu", "fv", "cu", "cv"],
}


def parameters(camera):
    """(name, value) of everything that describes the lens."""
    names = NAMES[camera["camera_model"]] + [f"d{i}" for i in range(len(camera["distortion_coeffs"]))]
    return list(zip(names, camera["intrinsics"] + camera["distortion_coeffs"]))


def rotation_mrad(a, b):
    """Angle between the rotations of two 4x4 matrices, from the size of R_a R_b^T - I, which keeps its digits near 0."""
    squared = sum((a[row][col] - b[row][col]) ** 2 for row in range(3) for col in range(3))
    return 2e3 * math.asin(min(1.0, math.sqrt(squared / 8.0)))


def translation_mm(a, b):
    return 1e3 * math.dist([row[3] for row in a[:3]], [row[3] for row in b[:3]])


def compare_camera(name, result, truth):
    print(f"{name} ({truth['rostopic']}), {truth['camera_model']}-{truth['distortion_model']}")
    if [result[key] for key in ("camera_model", "distortion_model")] != [truth[key] for key in ("camera_model", "distortion_model")]:
        print("  of another model than the truth")
        return
    print(f"  {'':8}{'result':>14}{'truth':>14}{'difference':>14}")
    for (label, value), (_, true_value) in zip(parameters(result), parameters(truth)):
        print(f"  {label:8}{value:14.6f}{true_value:14.6f}{value - true_value:+14.6f}")
    if "T_cn_cnm1" in truth:
        a, b = result["T_cn_cnm1"], truth["T_cn_cnm1"]
        print(f"  T_cn_cnm1: {rotation_mrad(a, b):.4f} mrad and {translation_mm(a, b):.4f} mm from the truth")


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__.strip())
    result, truth = (yaml.safe_load(open(file)) for file in sys.argv[1:])
    for name in sorted(truth, key=lambda name: int(name[3:])):
        compare_camera(name, result[name], truth[name])


if __name__ == "__main__":
    main()
