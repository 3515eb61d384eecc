"""Distances of corners, anybody's, from where a calibration with one pinhole camera sees them."""

import numpy as np

from benchmarks.common import read_corners
from benchmarks.truth import rotation


def equidistant(coefficients, x, y):
    radius = np.hypot(x, y)
    theta = np.arctan(radius)
    scale = theta * (1 + sum(k * theta ** (2 * i) for i, k in enumerate(coefficients, 1))) / radius
    return scale * x, scale * y


def radtan(coefficients, x, y):
    k1, k2, p1, p2 = coefficients
    square = x * x + y * y
    scale = 1 + k1 * square + k2 * square * square
    return (scale * x + 2 * p1 * x * y + p2 * (square + 2 * x * x), scale * y + p1 * (square + 2 * y * y) + 2 * p2 * x * y)


DISTORTIONS = {"pinhole-equi": equidistant, "pinhole-radtan": radtan}


def residuals_px(record, corners, board_point):
    """{(stamp, corner id): distance} of a corner file, for the views that the calibration record has a pose of.
    board_point: corner id to its place on the board [m]."""
    camera = record["cameras"]["cam0"]
    fu, fv, cu, cv = camera["intrinsics"]
    poses = {view["stamp_ns"]: np.array(view["T_rig_target"]) for view in record["views"]}
    result = {}
    for row in read_corners(corners)[1]:
        stamp, corner = int(row["stamp_ns"]), int(row["corner_id"])
        if stamp in poses:
            x, y, z = rotation(poses[stamp][:4]) @ board_point(corner) + poses[stamp][4:]
            x, y = DISTORTIONS[camera["model"]](camera["distortion_coeffs"], x / z, y / z)
            result[(stamp, corner)] = np.hypot(fu * x + cu - float(row["u_px"]), fv * y + cv - float(row["v_px"]))
    return result
