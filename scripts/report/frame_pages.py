"""Pages with pictures, the rig in space, and the verdict."""

import textwrap

import matplotlib.pyplot as plt
import numpy as np
from style import (CYCLE, GRADES, GREY, ORANGE, RED, equal_3d_axes, histogram, image_page, magnification, page, panels,
                   steps)

WORST_LENGTH_RATIO = 0.012  # of the image's width, for most of the lines
WRAP_COLUMNS = 125
VERDICT_TOP, VERDICT_BOTTOM = 0.88, 0.04  # of the page's height, as are the next two
VERDICT_LINE = 0.026
SUMMARY_GAP = 0.04


def verdict_page(report):
    """The verdict with all that it rests on, and a table of the cameras; on further pages what does not fit."""
    verdict = report.verdict
    title = f"Calibration of {report.name}"
    figure, height = page(title), 0.79
    figure.text(0.07, 0.86, f"Verdict: {verdict['grade']}", fontsize=22, weight="bold", color="white",
                bbox={"facecolor": GRADES[verdict["grade"]], "edgecolor": "none", "boxstyle": "round,pad=0.4"})
    for colour, text in verdict_lines(report):
        parts = textwrap.wrap(text, WRAP_COLUMNS, subsequent_indent="      ")
        if height - VERDICT_LINE * len(parts) < VERDICT_BOTTOM:
            yield "Verdict", figure
            figure, height = page(f"{title}, continued"), VERDICT_TOP
        for part in parts:
            figure.text(0.07, height, part, color=colour, fontsize=10, va="top")
            height -= VERDICT_LINE
        height -= 0.3 * VERDICT_LINE
    size = 0.055 + 0.028 * len(report.cameras)
    if height - SUMMARY_GAP - size < VERDICT_BOTTOM:
        yield "Verdict", figure
        figure, height = page(f"{title}, continued"), VERDICT_TOP
    add_summary(figure, report, [0.05, height - SUMMARY_GAP - size, 0.9, size])
    yield "Verdict", figure


def verdict_lines(report):
    """Colour and text."""
    verdict = report.verdict
    lines = [("black", fact) for fact in verdict["facts"]]
    lines += [(GRADES[reason["grade"]], f"{reason['grade']}: {reason['text']}") for reason in verdict["reasons"]]
    if not verdict["reasons"]:
        lines.append((GRADES["good"], "Nothing speaks against this calibration."))
    return lines + [("#404040", f"note: {warning}") for warning in report.warnings]


def small(value):
    """A positive number with three decimals that is never said to be nothing."""
    return f"{value:.3f}" if value >= 0.0005 else "< 0.001"


def summary(report):
    """Headings and rows of a table of the cameras."""
    columns = ["camera", "model", "views", "corners", "rms (px)", "median (px)", "reach of corners / image (deg)",
               "focal length\nuncertain to (%)", "projection\nuncertain to (px)", "odd against\neven (px)"]
    rows = []
    for camera in report.cameras:
        statistics = camera.statistics
        difference = camera.median_difference_px
        rows.append([camera.name, camera.model, statistics["views"], statistics["corners"], f"{statistics['rms_px']:.3f}",
                     f"{statistics['median_px']:.3f}", f"{camera.max_polar_deg:.0f} / {camera.reach_deg:.0f}",
                     small(100 * camera.focal_stdev_ratio), small(camera.median_stdev_px),
                     "not measured" if difference is None else small(difference)])
    return columns, rows


def add_summary(figure, report, place):
    """The table of the cameras; `place` as left, bottom, width, height."""
    columns, rows = summary(report)
    axes = figure.add_axes(place)
    axes.axis("off")
    table = axes.table(rows, colLabels=columns, cellLoc="center", bbox=[0.0, 0.0, 1.0, 1.0],
                       colWidths=[0.07, 0.12, 0.06, 0.08, 0.08, 0.09, 0.19, 0.11, 0.11, 0.11])
    table.auto_set_font_size(False)
    table.set_fontsize(8)
    for (row, _), cell in table.get_celld().items():
        cell.set_edgecolor("#C0C0C0")
        cell.set_height(2.0 if row == 0 else 1.0)


def rig_page(report):
    figure = page("Rig and boards", "Cameras as pyramids of 30 degrees to each side, looking where the optical axis does; the boards of "
                                    "all views in grey. Metres in cam0's frame: x right, y down, z along its optical axis.")
    axes = figure.add_axes([0.12, 0.08, 0.76, 0.82], projection="3d")
    corners = outline(report.board_m)
    boards = np.einsum("nij,kj->nki", report.T_rig_target[:, :3, :3], corners) + report.T_rig_target[:, None, :3, 3]
    gaps = np.full((len(boards), 1, 3), np.nan)
    axes.plot(*upright(np.concatenate([boards, gaps], axis=1).reshape(-1, 3)).T, color=GREY, linewidth=0.5, alpha=0.6)
    places = np.array([camera.T_rig_cam[:3, 3] for camera in report.cameras])
    length = 0.08 * max(0.2, float(np.ptp(boards.reshape(-1, 3), axis=0).max()))
    for index, camera in enumerate(report.cameras):
        pyramid = camera.T_rig_cam[:3, :3] @ (length * pyramid_lines()).T + camera.T_rig_cam[:3, 3:]
        axes.plot(*upright(pyramid.T).T, color=CYCLE[index % len(CYCLE)], linewidth=1.8, label=camera.name)
    axes.legend(loc="upper left")
    equal_3d_axes(axes, upright(np.vstack([boards.reshape(-1, 3), places])), ("x", "z", "-y"))
    axes.view_init(elev=25, azim=-60)
    yield "Rig and boards", figure


def upright(points):
    """Drawn with z upwards, a camera's y, which points down, becomes -z and its optical axis y."""
    return points @ np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])


def outline(points):
    """Corners of the board's bounding rectangle, closed."""
    low, high = points.min(axis=0), points.max(axis=0)
    return np.array([[low[0], low[1], 0], [high[0], low[1], 0], [high[0], high[1], 0], [low[0], high[1], 0], [low[0], low[1], 0]])


def pyramid_lines():
    """One line along all edges of a pyramid with its top in the origin."""
    base = np.array([[x, y, 1.0] for x, y in ((-0.6, -0.6), (0.6, -0.6), (0.6, 0.6), (-0.6, 0.6))])
    top = np.zeros(3)
    return np.array([top, base[0], base[1], top, base[2], base[1], base[2], base[3], top, base[0], base[3]])


def in_picture(picture, u_px, v_px):
    """Coordinates in a picture of pixels of its image."""
    origin_u, origin_v = picture["origin_px"][0]
    return (u_px - origin_u + 0.5) * picture["scale"] - 0.5, (v_px - origin_v + 0.5) * picture["scale"] - 0.5


def show_picture(axes, report, picture):
    image = plt.imread(report.picture(picture["file"]))
    axes.imshow(image, cmap="gray", vmin=0, vmax=255)
    axes.set_xlim(-0.5, image.shape[1] - 0.5)
    axes.set_ylim(image.shape[0] - 0.5, -0.5)
    axes.set_xticks([])
    axes.set_yticks([])
    axes.grid(False)


def worst_page(report, camera):
    title = f"{camera.name}: the {len(camera.worst)} frames with the largest residuals"
    factor = min(worst_magnification(other) for other in report.cameras)
    figure = page(title, f"The board, cut out. Circles: used corners as found. Crosses: rejected ones. Lines: from the corner to where the "
                         f"model puts it, {factor:g} times as long.")
    cells = panels(figure, 3, 2, left=0.03, right=0.97, bottom=0.08, top=0.9, wspace=0.06, hspace=0.16).ravel()
    for axes, picture in zip(cells, camera.worst):
        show_picture(axes, report, picture)
        used = camera.used.where(camera.used.view == picture["view"])
        rejected = camera.rejected.where(camera.rejected.view == picture["view"])
        for corners, mark, colour in ((used, "o", ORANGE), (rejected, "x", RED)):
            x, y = in_picture(picture, corners.u_px, corners.v_px)
            axes.plot(x, y, mark, color=colour, markersize=3, fillstyle="none", linewidth=0, markeredgewidth=0.8)
            lines = [np.stack([start, start - factor * picture["scale"] * residual, np.full_like(start, np.nan)], axis=1).ravel()
                     for start, residual in ((x, corners.du_px), (y, corners.dv_px))]
            axes.plot(*lines, color=colour, linewidth=0.8)
        rms = np.sqrt(np.mean(used.du_px ** 2 + used.dv_px ** 2)) if used.size else np.nan
        axes.set_title(f"view {picture['view']} at {report.times_s[picture['view']]:.2f} s: rms {rms:.3f} px, {used.size} used, "
                       f"{rejected.size} rejected", fontsize=8)
    for axes in cells[len(camera.worst):]:
        axes.axis("off")
    yield title, figure


def worst_magnification(camera):
    """How many times as long residuals can be drawn in the camera's worst frames."""
    worst = camera.used.where(np.isin(camera.used.view, [picture["view"] for picture in camera.worst]))
    return magnification(np.hypot(worst.du_px, worst.dv_px), WORST_LENGTH_RATIO * camera.width) if worst.size else np.inf


def rounds_page(report, camera):
    """The frame in which the rounds found most, as the paper's figure 1."""
    gained = camera.found.where(camera.found.round > 0)
    by_view = np.bincount(gained.view.astype(int), minlength=len(report.views))
    picture = max(camera.frames, key=lambda frame: by_view[frame["view"]])
    title = f"{camera.name}: corners by round"
    note = ("Round 0 detects without a model; every later round looks where the model of the round before says that corners are. The "
            "picture is the one in which that found most.")
    figure = image_page(title, note, camera)
    left, right = panels(figure, 2, left=0.03, wspace=0.2)[0]
    show_picture(left, report, picture)
    here = camera.found.where(camera.found.view == picture["view"])
    missed = camera.missed.where(camera.missed.view == picture["view"])
    rounds = range(int(max(other.found.round.max(initial=0) for other in report.cameras)) + 1)
    for number in rounds:
        corners = here.where(here.round == number)
        left.plot(*in_picture(picture, corners.u_px, corners.v_px), "o", color=round_colour(number), markersize=4,
                  fillstyle="none" if number == 0 else "full", markeredgewidth=1, label=f"round {number}: {corners.size} corners")
    left.plot(*in_picture(picture, missed.u_px, missed.v_px), "x", color=RED, markersize=4, label=f"not found: {missed.size}")
    left.set_title(f"view {picture['view']} at {report.times_s[picture['view']]:.2f} s")
    left.legend(loc="upper center", bbox_to_anchor=(0.5, -0.02), ncol=2)
    bands = np.arange(0.0, max(other.max_polar_deg for other in report.cameras) + 10.0, 10.0)
    below = np.zeros(len(bands) - 1)
    for number in rounds:
        counts = histogram(camera.found.polar_deg[camera.found.round == number], bands)
        steps(right, bands, counts, below, color=round_colour(number), label=f"round {number}: {counts.sum()}")
        below += counts
    right.set_xlim(0, bands[-1])
    right.set_ylim(0, 1.05 * max(1, *(histogram(other.found.polar_deg, bands).max() for other in report.cameras)))
    right.set_title("all views")
    right.set_xlabel("angle from the optical axis (deg)")
    right.set_ylabel("corners in 10 degrees")
    right.legend()
    yield title, figure


def round_colour(number):
    return (CYCLE[5], CYCLE[1], CYCLE[2], CYCLE[4], CYCLE[7])[min(number, 4)]


def parts(report):
    """Generators of pages, of which none draws before it is asked."""
    yield rig_page(report)
    for camera in report.cameras:
        if camera.worst:
            yield worst_page(report, camera)
        if camera.frames and report.rounds:
            yield rounds_page(report, camera)
