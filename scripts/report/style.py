"""One look for all pages: A4 landscape, colours that colour-blind readers tell apart (Okabe and Ito; viridis for amounts)."""

import textwrap

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt  # noqa: E402  the backend comes first
import numpy as np  # noqa: E402

PAGE_INCHES = (11.7, 8.3)
NOTE_COLUMNS = 150

BLUE = "#0072B2"
ORANGE = "#E69F00"
GREEN = "#009E73"
RED = "#D55E00"
PURPLE = "#CC79A7"
SKY = "#56B4E9"
GREY = "#7F7F7F"
CYCLE = [BLUE, ORANGE, GREEN, RED, PURPLE, SKY, "#000000", "#F0E442"]
GRADES = {"good": "#007A5A", "usable": "#855B00", "repeat": "#B84F00"}  # dark enough for text on white
AMOUNTS = "viridis"

plt.rcParams.update({
    "figure.figsize": PAGE_INCHES,
    "figure.titlesize": 14,
    "font.size": 9,
    "axes.titlesize": 10,
    "axes.grid": True,
    "grid.alpha": 0.3,
    "axes.prop_cycle": matplotlib.cycler(color=CYCLE),
    "legend.fontsize": 8,
    "pdf.compression": 3,  # half the time of 6 for a tenth more bytes
    "path.simplify": True,
})


def page(title, note=""):
    """A figure with a title on top and, where there is one, an explanation at the bottom."""
    figure = plt.figure()
    figure.suptitle(title, y=0.965)
    if note:
        figure.text(0.5, 0.022, textwrap.fill(note, NOTE_COLUMNS), ha="center", va="bottom", fontsize=8.5, color="#404040")
    return figure


def panels(figure, columns=2, rows=1, **spacing):
    """Axes on the page between title and note."""
    layout = {"left": 0.07, "right": 0.96, "top": 0.88, "bottom": 0.14, "wspace": 0.22, "hspace": 0.35, **spacing}
    return figure.subplots(rows, columns, gridspec_kw=layout, squeeze=False)


def image_axes(axes, camera, title=""):
    """Pixels as in the image: v down, same scale in both directions, (0, 0) the centre of the first pixel."""
    axes.set_xlim(-0.5, camera.width - 0.5)
    axes.set_ylim(camera.height - 0.5, -0.5)
    axes.set_aspect("equal")
    axes.set_xlabel("u (px)")
    axes.set_ylabel("v (px)")
    axes.set_title(title, loc="left")


def legend_above(axes, columns=2):
    """A legend at the upper right edge of the axes that hides nothing in them."""
    axes.legend(loc="lower right", bbox_to_anchor=(1.01, 1.0), ncol=columns, frameon=False, borderpad=0.1, columnspacing=1.0)


def colour_bar(figure, mappable, axes, label, **options):
    """A bar that takes its place below the axes, whatever their shape."""
    return figure.colorbar(mappable, ax=axes, label=label, orientation="horizontal", fraction=0.05, pad=0.13, aspect=40,
                           **options)


def equal_3d_axes(axes, points, names="xyz"):
    """Metres at the same scale on all three axes, around all points."""
    low, high = points.min(axis=0), points.max(axis=0)
    centre, half = 0.5 * (low + high), max(0.05, 0.55 * float((high - low).max()))
    for set_limits, middle in zip((axes.set_xlim, axes.set_ylim, axes.set_zlim), centre):
        set_limits(middle - half, middle + half)
    axes.set_box_aspect((1, 1, 1))
    for set_label, name in zip((axes.set_xlabel, axes.set_ylabel, axes.set_zlabel), names):
        set_label(f"{name} (m)", labelpad=8)
    axes.tick_params(pad=3, labelsize=8)


def draw_frames(axes, poses, length):
    """Axes x red-orange, y green, z blue of each T_world_frame, as three line collections."""
    for column, colour in enumerate((RED, GREEN, BLUE)):
        starts = poses[:, :3, 3]
        ends = starts + length * poses[:, :3, column]
        gaps = np.full_like(starts, np.nan)
        line = np.stack([starts, ends, gaps], axis=1).reshape(-1, 3)
        axes.plot(line[:, 0], line[:, 1], line[:, 2], color=colour, linewidth=1.0)


def magnification(lengths, wanted):
    """The largest of 1, 2, 5, 10, 20 ... that makes nearly all lengths shorter than wanted."""
    lengths = lengths[np.isfinite(lengths)]
    ratio = max(1.0, wanted / max(np.quantile(lengths, 0.9), 1e-9)) if lengths.size else 1.0
    power = 10.0 ** np.floor(np.log10(ratio))
    return power * max(digit for digit in (1, 2, 5) if digit * power <= ratio)
