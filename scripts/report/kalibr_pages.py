"""Kalibr's pages, in Kalibr's order."""

import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from style import (AMOUNTS, BLUE, ORANGE, RED, colour_bar, draw_frames, equal_3d_axes, image_axes, image_page, page,
                   panels, view_points)

LINES_PER_PAGE = 35


def text_pages(report):
    lines = report.results_text.rstrip().split("\n")
    for first in range(0, len(lines), LINES_PER_PAGE):
        figure = page("")
        text = "\n".join(lines[first:first + LINES_PER_PAGE])
        figure.text(0.07, 0.93, text, va="top", family="monospace", fontsize=9, linespacing=1.35)
        yield "Calibration results", figure


def graph_page(report):
    title = "Inter-camera observations graph (edge weight=#mutual obs.)"
    count = len(report.cameras)
    half_height = 0.4 if count == 2 else 1.3
    figure = page(title, "Cameras that see the board in the same views, joined by the number of corners that both see.",
                  1.5 + 2.6 * half_height)
    axes = panels(figure, 1)[0, 0]
    angles = np.pi - 2.0 * np.pi * np.arange(count) / count
    places = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    shared = np.array(report.shared_corners)
    for i in range(count):
        for j in range(i + 1, count):
            if shared[i, j] > 0:
                axes.plot(*zip(places[i], places[j]), color=ORANGE, linewidth=2, zorder=1)
                axes.text(*(0.5 * (places[i] + places[j])), f"{shared[i, j]:.0f}", ha="center", va="center",
                          bbox={"facecolor": "white", "edgecolor": ORANGE})
    for camera, place in zip(report.cameras, places):
        axes.text(*place, f"{camera.name}\n{camera.topic}", ha="center", va="center", fontsize=10, zorder=2,
                  bbox={"boxstyle": "round,pad=0.6", "facecolor": "#DCEAF5", "edgecolor": BLUE})
    axes.set_xlim(-1.6, 1.6)
    axes.set_ylim(-half_height, half_height)
    axes.set_aspect("auto" if count == 2 else "equal")
    axes.axis("off")
    yield title, figure


def camera_system_page(report):
    figure = page("camera system", "Frames of the cameras in that of cam0: x red, y green, z (the optical axis) blue.")
    axes = figure.add_axes([0.12, 0.08, 0.76, 0.82], projection="3d")
    poses = np.array([camera.T_rig_cam for camera in report.cameras])
    places = poses[:, :3, 3]
    length = 0.35 * max(0.02, float(np.ptp(places, axis=0).max()))
    draw_frames(axes, poses, length)
    for camera, place in zip(report.cameras, places):
        axes.text(*(place - 0.15 * length), camera.name, ha="right", va="top")
    equal_3d_axes(axes, np.vstack([places, places + length * poses[:, :3, 2], places + length * poses[:, :3, 0]]))
    yield "camera system", figure


def poses_page(report):
    poses = np.linalg.inv(report.T_rig_target)
    places = poses[:, :3, 3]
    title = "cam0: estimated poses"
    figure = page(title, "Poses of cam0 in the board's frame, joined in order of time: x red, y green, z blue. The board is grey.")
    axes = figure.add_axes([0.12, 0.08, 0.76, 0.82], projection="3d")
    axes.plot(*places.T, color="#A0A0A0", linewidth=0.6)
    axes.plot(*report.board_m.T, ".", color="#808080", markersize=1.5)
    draw_frames(axes, poses, 0.06 * max(0.1, float(np.ptp(places, axis=0).max())))
    equal_3d_axes(axes, np.vstack([places, report.board_m]))
    yield title, figure


def error_over_angle(report, camera, kind):
    def angles_of(other):
        return np.nan_to_num(other.used.polar_deg if kind == "polar" else other.used.azimuth_deg)

    angles = angles_of(camera)
    title = f"{camera.name}: {kind} error"
    figure = page(title, "Length of every used corner's residual over the angle of its measured ray, and how many corners there are.")
    left, right = panels(figure)[0]
    errors = np.hypot(camera.used.du_px, camera.used.dv_px)
    left.plot(angles, errors, ".", color=BLUE, markersize=2, alpha=0.4, rasterized=True)
    left.set_ylim(0, error_limit(report))
    left.set_ylabel("reprojection error (px)")
    angles_of_all = [angles_of(other) for other in report.cameras]
    bins = np.linspace(min(other.min(initial=0.0) for other in angles_of_all),
                       max(other.max(initial=1.0) for other in angles_of_all), 37)
    right.hist(angles, bins=bins, color=BLUE)
    right.set_ylim(0, 1.05 * max(max(np.histogram(other, bins)[0].max() for other in angles_of_all), 1))
    right.set_ylabel("corners")
    for axes in (left, right):
        axes.set_xlabel(f"{kind} angle (deg)")
    yield title, figure


def error_limit(report):
    """The same for all cameras of a run."""
    lengths = np.concatenate([np.hypot(camera.used.du_px, camera.used.dv_px) for camera in report.cameras])
    lengths = lengths[np.isfinite(lengths)]
    return 1.05 * float(lengths.max()) if lengths.size else 1.0


def reprojection_page(report, camera):
    title = f"{camera.name}: reprojection errors"
    figure = image_page(title, "Used corners, coloured by the view that they are of; measured minus predicted.", camera)
    left, right = panels(figure)[0]
    image_axes(left, camera)
    view_points(left, camera.used.u_px, camera.used.v_px, camera.used.view)
    view_points(right, camera.used.du_px, camera.used.dv_px, camera.used.view)
    limit = error_limit(report)
    right.set_xlim(-limit, limit)
    right.set_ylim(-limit, limit)
    right.set_aspect("equal")
    right.set_xlabel("error x (px)")
    right.set_ylabel("error y (px)")
    views = ScalarMappable(Normalize(0, max(len(report.views) - 1, 1)), AMOUNTS)
    colour_bar(figure, views, [left, right], "view")
    yield title, figure


def outliers_page(report):
    cameras = [camera for camera in report.cameras if camera.rejected.size]
    title = "Location of removed outlier corners"
    figure = image_page(title, "Corners that were found but did not take part in the solve.", cameras[0], has_colour_bar=False)
    middle = {"left": 0.28, "right": 0.72} if len(cameras) == 1 else {}
    for axes, camera in zip(panels(figure, len(cameras), **middle)[0], cameras):
        image_axes(axes, camera, f"{camera.name}: {camera.rejected.size} of {camera.found.size} corners")
        axes.plot(camera.rejected.u_px, camera.rejected.v_px, "x", color=RED, markersize=4)
    yield title, figure


def pages(report):
    yield from text_pages(report)
    if len(report.cameras) > 1:
        yield from graph_page(report)
        yield from camera_system_page(report)
    if len(report.views) > 2:
        yield from poses_page(report)
    for camera in report.cameras:
        yield from error_over_angle(report, camera, "polar")
        yield from error_over_angle(report, camera, "azimuthal")
        yield from reprojection_page(report, camera)
    if any(camera.rejected.size for camera in report.cameras):
        yield from outliers_page(report)
