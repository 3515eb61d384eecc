"""One look for all pages: A4 landscape, colours that colour-blind readers tell apart (Okabe and Ito; viridis for amounts)."""

import textwrap

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt  # noqa: E402  the backend comes first
import numpy as np  # noqa: E402
from matplotlib.colors import LogNorm  # noqa: E402

PAGE_INCHES = (11.7, 8.3)
TITLE_INCHES = 0.95  # from the upper edge to the axes
LABELS_INCHES = 0.75  # from the lower edge to the axes, a note comes on top
LINE_INCHES = 0.15
BAR_GAP_INCHES = 0.55  # between axes and their colour bar: for the numbers and the label below the axes
DOTS_ACROSS = 240  # dots of about one and a half points
HEAD_RATIO = 0.3  # of an arrow
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
    "axes.titley": 1.0,  # looking for a place above ticks, which are nowhere above, takes a tenth of the time
    "axes.grid": True,
    "grid.alpha": 0.3,
    "axes.prop_cycle": matplotlib.cycler(color=CYCLE),
    "legend.fontsize": 8,
    "pdf.compression": 1,  # a third of the time of 6
    "path.simplify": True,
})


def page(title, note="", height=PAGE_INCHES[1]):
    """A figure with a title on top and, where there is one, an explanation at the bottom. `height` in inches."""
    figure = plt.figure(figsize=(PAGE_INCHES[0], height))
    figure.suptitle(title, y=1.0 - 0.3 / height)
    if note:
        figure.text(0.5, 0.18 / height, textwrap.fill(note, NOTE_COLUMNS), ha="center", va="bottom", fontsize=8.5,
                    color="#404040")
    return figure


def image_page(title, note, camera, has_colour_bar=True, columns=2):
    """A page of panels that is as high as the camera's image needs in one of them."""
    panel_inches = 0.8 / columns * PAGE_INCHES[0] * camera.height / camera.width
    labels = TITLE_INCHES + LABELS_INCHES + LINE_INCHES * len(textwrap.wrap(note, NOTE_COLUMNS))
    height = labels + panel_inches / (0.8 if has_colour_bar else 1.0)
    return page(title, note, min(max(height, 0.5 * PAGE_INCHES[1]), PAGE_INCHES[1]))


def panels(figure, columns=2, rows=1, **spacing):
    """Axes on the page between title and note."""
    height = figure.get_figheight()
    lines = sum(text.get_text().count("\n") + 1 for text in figure.texts if text is not figure._suptitle)
    layout = {"left": 0.07, "right": 0.96, "top": 1.0 - TITLE_INCHES / height, "wspace": 0.22, "hspace": 0.35,
              "bottom": (LABELS_INCHES + LINE_INCHES * lines) / height, **spacing}
    return figure.subplots(rows, columns, gridspec_kw=layout, squeeze=False)


def image_extent(camera):
    """Left, right, bottom, top of its pixels; (0, 0) is the centre of the first one."""
    return -0.5, camera.width - 0.5, camera.height - 0.5, -0.5


def image_axes(axes, camera, title=""):
    """Pixels as in the image: v down, same scale in both directions."""
    axes.axis(image_extent(camera))
    axes.set_aspect("equal")
    axes.set_xlabel("u (px)")
    axes.set_ylabel("v (px)")
    axes.set_title(title, loc="left")


def cells(axes, image, extent, **options):
    """An image of few cells, each as it is: a small picture in the file, however many corners it sums up."""
    return axes.imshow(image, extent=extent, interpolation="none", aspect=axes.get_aspect(), **options)


def cell_indices(x, y, shape, extent):
    """Row and column of each point in cells over an extent of left, right, bottom, top, and whether it is inside."""
    left, right, bottom, top = extent
    rows, columns = shape
    row, column = np.floor((top - y) / (top - bottom) * rows), np.floor((x - left) / (right - left) * columns)
    inside = (row >= 0) & (row <= rows) & (column >= 0) & (column <= columns)
    return np.minimum(row[inside], rows - 1).astype(int), np.minimum(column[inside], columns - 1).astype(int), inside


def cell_counts(x, y, shape, extent):
    """How many points are in each cell of rows and columns."""
    row, column, _ = cell_indices(x, y, shape, extent)
    return np.bincount(row * shape[1] + column, minlength=shape[0] * shape[1]).reshape(shape)


def view_points(axes, x, y, views, extent):
    """Points coloured by the view that they are of, later ones over earlier ones, as one image."""
    left, right, bottom, top = extent
    image = np.full((int(DOTS_ACROSS * abs((top - bottom) / (right - left))), DOTS_ACROSS), np.nan)
    row, column, inside = cell_indices(x, y, image.shape, extent)
    image[row, column] = views[inside]
    return cells(axes, np.ma.masked_invalid(image), extent, cmap=AMOUNTS, vmin=0, vmax=max(views.max(initial=0.0), 1.0))


def arrows(axes, u, v, du, dv, **options):
    """Arrows from (u, v), all as one line, which is fast to draw."""
    start, along = np.stack([u, v]), np.stack([du, dv])
    across = np.stack([-dv, du])
    head = start + along
    barbs = [head - HEAD_RATIO * (along + side * 0.5 * across) for side in (1.0, -1.0)]
    line = np.stack([start, head, barbs[0], head, barbs[1], np.full_like(start, np.nan)], axis=2).reshape(2, -1)
    axes.plot(*line, **options)


def histogram(values, edges):
    """Counts between edges of equal distance, which is all that NumPy needs to know to be fast; without what is not finite."""
    return np.histogram(values[np.isfinite(values)], len(edges) - 1, (edges[0], edges[-1]))[0]


def steps(axes, edges, values, below=0.0, **options):
    """Bars from edge to edge, all as one patch."""
    low, high = (np.repeat(level, 2) for level in (np.broadcast_to(below, np.shape(values)), below + np.asarray(values)))
    axes.fill_between(np.repeat(edges, 2)[1:-1], low, high, linewidth=0, **options)


def legend_above(axes, columns=2):
    """A legend at the upper right edge of the axes that hides nothing in them."""
    axes.legend(loc="lower right", bbox_to_anchor=(1.01, 1.0), ncol=columns, frameon=False, borderpad=0.1, columnspacing=1.0)


def colour_bar(figure, mappable, axes, label, **options):
    """A bar that takes its place below the axes, whatever their shape."""
    if isinstance(mappable.norm, LogNorm):
        options["format"] = "%g"  # powers of ten as formulas take long
    height_inches = np.ravel(axes)[0].get_position().height * figure.get_figheight()
    bar = figure.colorbar(mappable, ax=axes, label=label, orientation="horizontal", fraction=0.05,
                          pad=BAR_GAP_INCHES / height_inches, **{"aspect": 40, **options})
    bar.minorticks_off()
    return bar


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
