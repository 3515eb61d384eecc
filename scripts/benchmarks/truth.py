"""Truth of a rendered recording with one camera, and corner files scored against it."""

import csv
import pathlib

import numpy as np
import yaml

from benchmarks.common import read_corners

MAX_ERROR_PX = 2.0  # a corner farther from its true place is a false one
MIN_NEIGHBOUR_PX = 4.0  # corners whose nearest neighbour on the board is closer cannot be resolved and are not asked for
BAND_DEG = 10


class Truth:
    """What simulate says of every corner within the image: arrays of equal length, by stamp, then corner id."""

    def __init__(self, recording):
        bag, target, _ = recording.files
        base = str(bag.with_suffix(""))
        self.corners_path = pathlib.Path(f"{base}-truth-corners.csv")
        _, rows = read_corners(self.corners_path)
        with open(f"{base}-truth-visibility.csv") as file:
            seen = list(csv.DictReader(file))
        self.stamp_ns = np.array([int(row["stamp_ns"]) for row in rows])
        self.corner_id = np.array([int(row["corner_id"]) for row in rows])
        self.px = np.array([[float(row["u_px"]), float(row["v_px"])] for row in rows])
        # Root mean square distance of the best possible estimate: of the trace of the Cramer-Rao bound.
        self.bound_px = np.sqrt([float(row["cov_uu"]) + float(row["cov_vv"]) for row in rows])
        self.hidden = np.array([row["visibility"] == "hidden" for row in seen])
        visible = np.array([row["visibility"] == "visible" for row in seen])
        self.asked = visible & (np.array([float(row["neighbour_px"]) for row in seen]) >= MIN_NEIGHBOUR_PX)
        self.motion_px = np.array([float(row["motion_px"]) for row in seen])  # way during the exposure
        self.T_cam_target = read_poses(f"{base}-truth-poses.csv")  # (rotation, translation) by stamp
        self.polar_deg, self.azimuth_deg = self._angles(yaml.safe_load(target.read_text()))
        self.row_of = {key: row for row, key in enumerate(zip(self.stamp_ns.tolist(), self.corner_id.tolist()))}

    def asked_within(self, band):
        """Which corners are asked for and within a band of polar angle [degrees]."""
        return self.asked & (self.polar_deg >= band[0]) & (self.polar_deg < band[1])

    def _angles(self, target):
        """Polar angle from the camera's axis and azimuth of each corner."""
        rays = np.array([R @ board_point(target, corner) + t for (R, t), corner in
                         ((self.T_cam_target[stamp], corner) for stamp, corner in zip(self.stamp_ns.tolist(), self.corner_id))])
        polar = np.degrees(np.arctan2(np.hypot(rays[:, 0], rays[:, 1]), rays[:, 2]))
        return polar, np.degrees(np.arctan2(rays[:, 1], rays[:, 0]))


class Score:
    """Corners of a file, but for those that its solve rejected, against the truth. `row`, `error_px`: of those that the truth has
    within the image."""

    def __init__(self, truth, path):
        corners = [corner for corner in read_corners(path)[1] if corner["used"] != "0"]
        self.num_reported = len(corners)
        rows = np.array([truth.row_of.get((int(corner["stamp_ns"]), int(corner["corner_id"])), -1) for corner in corners], int)
        px = np.array([[float(corner["u_px"]), float(corner["v_px"])] for corner in corners]).reshape(-1, 2)
        known = rows >= 0
        self.row = rows[known]
        errors = px[known] - truth.px[self.row]
        self.error_px = np.hypot(*errors.T)
        hidden = truth.hidden[self.row]
        off = ~hidden & (self.error_px > MAX_ERROR_PX)
        self.num_absent, self.num_hidden, self.num_off = np.sum(~known), np.sum(hidden), np.sum(off)
        right = ~hidden & ~off & truth.asked[self.row]
        self.found = np.zeros(len(truth.px), bool)  # which of the truth's corners, of those asked for
        self.found[self.row[right]] = True
        self.found_row = self.row[right]
        self.found_error_px = self.error_px[right]
        self.found_bound_ratio = self.found_error_px / truth.bound_px[self.found_row]

    @property
    def num_false(self):
        return self.num_absent + self.num_hidden + self.num_off

    @property
    def false_ratio(self):
        return self.num_false / max(1, self.num_reported)


def bands(max_deg):
    """(from, to) of the bands of polar angle up to that which holds max_deg."""
    return [(start, start + BAND_DEG) for start in range(0, int(np.ceil(max_deg / BAND_DEG)) * BAND_DEG, BAND_DEG)]


def board_point(target, corner_id):
    """Corner of an AprilGrid in the target frame [m], from its parsed YAML."""
    pitch = target["tagSize"] * (1 + target["tagSpacing"])
    row, col = divmod(corner_id, 2 * target["tagCols"])
    return np.array([*(index // 2 * pitch + index % 2 * target["tagSize"] for index in (col, row)), 0.0])


def project(camera, T_cam_target, points):
    """Pixels of points of the board through a double sphere of a camchain."""
    if camera["camera_model"] != "ds":
        raise ValueError(f"the true lens is no double sphere but {camera['camera_model']}")
    xi, alpha, fu, fv, cu, cv = camera["intrinsics"]
    x, y, z = (points @ T_cam_target[0].T + T_cam_target[1]).T
    shifted = z + xi * np.sqrt(x * x + y * y + z * z)
    depth = alpha * np.sqrt(x * x + y * y + shifted * shifted) + (1 - alpha) * shifted
    return np.stack([fu * x / depth + cu, fv * y / depth + cv], axis=1)


def read_poses(path):
    """T_cam_target by stamp, of rows with T_target_cam: position, then the quaternion w, x, y, z."""
    poses = {}
    with open(path) as file:
        next(file)
        for stamp, *values in csv.reader(file):
            values = np.array(values, float)
            R_cam_target = rotation(values[3:]).T
            poses[int(stamp)] = (R_cam_target, -R_cam_target @ values[:3])
    return poses


def rotation(quaternion):
    w, x, y, z = quaternion
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                     [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                     [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])
