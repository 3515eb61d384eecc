"""Kalibr's pages, in Kalibr's order."""

import numpy as np
from matplotlib.colors import LogNorm
from style import (AMOUNTS, BLUE, ORANGE, RED, cell_counts, cells, colour_bar, draw_frames, equal_3d_axes, histogram, image_axes,
                   image_extent, image_page, page, panels, steps, view_points)

LINES_PER_PAGE = 35
LABELLED_GRAPH_CAMERAS = 3  # the edges of more cross each other, and with them their labels
ERROR_CELLS = (90, 120)  # rows and columns
SHOWN_RATIO = 0.999  # of all residuals
OUTLIER_PANELS = 4  # on a page


def text_pages(report):
    lines = report.results_text.rstrip().split("\n")
    for first in range(0, len(lines), LINES_PER_PAGE):
        figure = page("")
        text = "\n".join(lines[first:first + LINES_PER_PAGE])
        figure.text(0.07, 0.93, text, va="top", family="monospace", fontsize=9, linespacing=1.35)
        yield "Calibration results", figure


def graph_page(report):
    title = "Inter-camera observations graph (edge weight=#mutual obs.)"
    note = "Cameras that see the board in the same views, joined by the number of corners that both see."
    count = len(report.cameras)
    if count > LABELLED_GRAPH_CAMERAS:
        figure = page(title, f"{note} The wider, the more.")
        left, right = panels(figure, wspace=0.1)[0]
        draw_graph(left, report, [camera.name for camera in report.cameras], has_weights=False)
        draw_shared_corners(right, report)
    else:
        half_height = 0.4 if count == 2 else 1.3
        figure = page(title, note, 1.5 + 2.6 * half_height)
        axes = panels(figure, 1)[0, 0]
        draw_graph(axes, report, [f"{camera.name}\n{camera.topic}" for camera in report.cameras], has_weights=True)
        axes.set_ylim(-half_height, half_height)
        axes.set_aspect("auto" if count == 2 else "equal")
    yield title, figure


def draw_graph(axes, report, labels, has_weights):
    count = len(report.cameras)
    angles = np.pi - 2.0 * np.pi * np.arange(count) / count
    places = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    shared = np.array(report.shared_corners)
    for i, j in zip(*np.nonzero(np.triu(shared, 1))):
        width = 2.0 if has_weights else 0.5 + 5.0 * shared[i, j] / np.triu(shared, 1).max()
        axes.plot(*zip(places[i], places[j]), color=ORANGE, linewidth=width, zorder=1)
        if has_weights:
            axes.text(*(0.5 * (places[i] + places[j])), f"{shared[i, j]:.0f}", ha="center", va="center",
                      bbox={"facecolor": "white", "edgecolor": ORANGE})
    for label, place in zip(labels, places):
        axes.text(*place, label, ha="center", va="center", fontsize=10, zorder=2,
                  bbox={"boxstyle": "round,pad=0.6", "facecolor": "#DCEAF5", "edgecolor": BLUE})
    axes.set_xlim(-1.6, 1.6)
    axes.set_ylim(-1.6, 1.6)
    axes.set_aspect("equal")
    axes.axis("off")


def draw_shared_corners(axes, report):
    """As a table, and the topics below."""
    shared = np.array(report.shared_corners)
    names = [camera.name for camera in report.cameras]
    numbers = [[f"{shared[i, j]:.0f}" if i != j else "" for j in range(len(names))] for i in range(len(names))]
    table = axes.table(numbers, rowLabels=names, colLabels=names, cellLoc="center", bbox=[0.08, 0.55, 0.92, 0.4])
    table.auto_set_font_size(False)
    table.set_fontsize(8)
    for cell in table.get_celld().values():
        cell.set_edgecolor("#C0C0C0")
    topics = "\n".join(f"{camera.name}: {camera.topic}" for camera in report.cameras)
    axes.text(0.0, 0.45, topics, transform=axes.transAxes, va="top", linespacing=1.6)
    axes.axis("off")


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

    def counts_of(other):
        return cell_counts(angles_of(other), residual_lengths(other), ERROR_CELLS, extent)

    angles_of_all = [angles_of(other) for other in report.cameras]
    bins = np.linspace(min(other.min(initial=0.0) for other in angles_of_all),
                       max(other.max(initial=1.0) for other in angles_of_all), 37)
    limit = error_limit(report)
    extent = (bins[0], bins[-1], 0.0, limit)
    counts = counts_of(camera)
    most = max(2.0, *(counts_of(other).max() for other in report.cameras))
    title = f"{camera.name}: {kind} error"
    note = ("Length of every used corner's residual over the angle of its measured ray, and how many corners there are. Colours, "
            f"logarithmic: from 1 corner (dark) to {most:.0f} (bright).")
    figure = page(title, note)
    left, right = panels(figure)[0]
    cells(left, np.ma.masked_equal(counts, 0), extent, cmap=AMOUNTS, norm=LogNorm(1.0, most))
    left.set_title(beyond(residual_lengths(camera) > limit))
    left.set_ylabel("reprojection error (px)")
    steps(right, bins, histogram(angles_of(camera), bins), color=BLUE)
    right.set_xlim(bins[0], bins[-1])
    right.set_ylim(0, 1.05 * max(max(histogram(other, bins).max() for other in angles_of_all), 1))
    right.set_ylabel("corners")
    for axes in (left, right):
        axes.set_xlabel(f"{kind} angle (deg)")
    yield title, figure


def residual_lengths(camera):
    return np.hypot(camera.used.du_px, camera.used.dv_px)


def error_limit(report):
    """The same for all cameras of a run, and not that of a few corners which would leave the others in one heap."""
    lengths = np.concatenate([residual_lengths(camera) for camera in report.cameras])
    return 1.05 * max(float(np.quantile(lengths, SHOWN_RATIO)), 1e-6) if lengths.size else 1.0


def beyond(is_beyond):
    return f"{is_beyond.sum()} of {is_beyond.size} corners are beyond the scale" if is_beyond.any() else ""


def reprojection_page(report, camera):
    title = f"{camera.name}: reprojection errors"
    figure = image_page(title, "Used corners, coloured by the view that they are of; measured minus predicted.", camera)
    left, right = panels(figure)[0]
    used, limit = camera.used, error_limit(report)
    image_axes(left, camera)
    view_points(left, used.u_px, used.v_px, used.view, image_extent(camera))
    right.set_aspect("equal")
    image = view_points(right, used.du_px, used.dv_px, used.view, (-limit, limit, -limit, limit))
    right.set_title(beyond(np.maximum(np.abs(used.du_px), np.abs(used.dv_px)) > limit))
    right.set_xlabel("error x (px)")
    right.set_ylabel("error y (px)")
    colour_bar(figure, image, [left, right], "view")
    yield title, figure


def outliers_pages(report):
    cameras = [camera for camera in report.cameras if camera.rejected.size]
    title = "Location of removed outlier corners"
    note = "Corners that were found but did not take part in the solve."
    for first in range(0, len(cameras), OUTLIER_PANELS):
        shown = cameras[first:first + OUTLIER_PANELS]
        columns, rows = min(len(shown), 2), (len(shown) + 1) // 2
        figure = page(title, note) if rows > 1 else image_page(title, note, shown[0], has_colour_bar=False)
        middle = {"left": 0.28, "right": 0.72} if columns == 1 else {}
        places = panels(figure, columns, rows, **middle)
        for axes, camera in zip(places.ravel(), shown):
            image_axes(axes, camera, f"{camera.name}: {camera.rejected.size} of {camera.found.size} corners")
            axes.plot(camera.rejected.u_px, camera.rejected.v_px, "x", color=RED, markersize=4)
        for axes in places.ravel()[len(shown):]:
            axes.axis("off")
        yield title, figure


def parts(report):
    """Generators of pages, of which none draws before it is asked."""
    yield text_pages(report)
    if len(report.cameras) > 1:
        yield graph_page(report)
        yield camera_system_page(report)
    if len(report.views) > 2:
        yield poses_page(report)
    for camera in report.cameras:
        yield error_over_angle(report, camera, "polar")
        yield error_over_angle(report, camera, "azimuthal")
        yield reprojection_page(report, camera)
    yield outliers_pages(report)
