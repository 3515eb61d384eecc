"""Pages that tell whether to trust the result: coverage, residuals, uncertainty. Cameras share their scales."""

import numpy as np
from matplotlib.colors import LogNorm
from matplotlib.ticker import NullLocator
from style import (AMOUNTS, BLUE, CYCLE, GREY, ORANGE, RED, arrows, cell_counts, cells, colour_bar, histogram, image_axes,
                   image_extent, image_page, legend_above, magnification, page, panels, steps)

BAND_DEG = 5.0
MAP_LEVELS_PX = (0.0003, 0.001, 0.003, 0.01, 0.03, 0.3, 1.0, 3.0, 10.0)
FAIR_PX = 0.1  # about what detection of one corner is good for: a projection better than that is not the weakest part
MAX_ARROWS = 2500
MIN_IN_CELL = 10
COVERAGE_COLUMNS = 40
NO_BIAS = {"mean_px": 0.0, "stdev_px": 0.0}


def shared_max(report, values_of):
    """Largest value over all cameras, so that their axes agree."""
    values = [np.nanmax(values_of(camera), initial=0.0) for camera in report.cameras]
    return max(values) or 1.0


def coverage_page(report, camera):
    def expected(other):
        return np.append(other.found.polar_deg, other.missed.polar_deg)

    title = f"{camera.name}: coverage"
    figure = image_page(title, "Missed: the solution expects the corner in the image, but nothing was found there: hidden, blurred, "
                               "too small, or outside of the lens's image circle. Dashed: the farthest used corner, at "
                               f"{camera.max_polar_deg:.0f} degrees.", camera, columns=3)
    left, middle, right = panels(figure, 3, wspace=0.28)[0]
    most = max(2.0, shared_max(report, lambda other: np.maximum(coverage(other.found, other), coverage(other.missed, other))))
    for axes, corners, kind in ((left, camera.found, "found"), (middle, camera.missed, "missed")):
        image_axes(axes, camera, f"{corners.size} corners {kind}")
        image = cells(axes, np.ma.masked_equal(coverage(corners, camera), 0), image_extent(camera), cmap=AMOUNTS, vmin=0, vmax=most)
        draw_ring(axes, camera)
    colour_bar(figure, image, [left, middle], "corners in a cell")
    bands = np.arange(0.0, shared_max(report, expected) + BAND_DEG, BAND_DEG)
    found, missed = histogram(camera.found.polar_deg, bands), histogram(camera.missed.polar_deg, bands)
    steps(right, bands, found, color=BLUE, label="found")
    steps(right, bands, missed, found, facecolor=ORANGE, edgecolor="white", hatch="//", label="missed")
    right.set_xlim(0, bands[-1])
    right.set_ylim(0, 1.05 * shared_max(report, lambda other: histogram(expected(other), bands)))
    right.set_xlabel("angle from the optical axis (deg)")
    right.set_ylabel(f"corners in {BAND_DEG:g} degrees")
    legend_above(right)
    yield title, figure


def coverage(corners, camera):
    """How many corners are in each square cell of the image."""
    rows = max(1, round(COVERAGE_COLUMNS * camera.height / camera.width))
    return cell_counts(corners.u_px, corners.v_px, (rows, COVERAGE_COLUMNS), image_extent(camera))


def draw_ring(axes, camera):
    """How far from the axis corners go, as a line in the image."""
    polar = np.ma.masked_invalid(camera.grid("polar_deg"))
    if polar.count() and polar.min() < camera.max_polar_deg < polar.max():
        axes.contour(camera.grid("u_px"), camera.grid("v_px"), polar, [camera.max_polar_deg], colors="black",
                     linestyles="dashed", linewidths=1)


def vectors_page(report, camera):
    title = f"{camera.name}: residual vectors"
    note = ("Measured minus predicted, magnified. Left single corners: without direction or pattern where all is well. Right "
            "means over cells: what is left there the lens model or the board cannot follow.")
    figure = image_page(title, note, camera, has_colour_bar=False)
    step = every_nth(camera)
    for axes, arrows_of, what in ((panels(figure)[0, 0], some_arrows, f"every {ordinal(step)} corner" if step > 1 else "all corners"),
                                  (figure.axes[1], cell_means, "means of cells")):
        u, v, du, dv = arrows_of(camera)
        factor = min(magnification(np.hypot(*arrows_of(other)[2:]), 0.04 * other.width) for other in report.cameras)
        image_axes(axes, camera, f"{what}, {factor:g} times")
        arrows(axes, u, v, factor * du, factor * dv, color=BLUE, linewidth=0.6)
    yield title, figure


def every_nth(camera):
    return max(1, camera.used.size // MAX_ARROWS)


def ordinal(number):
    ending = "th" if number % 100 in (11, 12, 13) else {1: "st", 2: "nd", 3: "rd"}.get(number % 10, "th")
    return f"{number}{ending}"


def some_arrows(camera):
    used = camera.used
    return [column[::every_nth(camera)] for column in (used.u_px, used.v_px, used.du_px, used.dv_px)]


def cell_means(camera, columns=16):
    """Centre of each cell of the image with enough corners, and their mean residual."""
    size = camera.width / columns
    column, row = (np.floor((coordinate + 0.5) / size).astype(int) for coordinate in (camera.used.u_px, camera.used.v_px))
    cells, index, counts = np.unique(row * columns + column, return_inverse=True, return_counts=True)
    means = [np.bincount(index, values) / counts for values in (camera.used.du_px, camera.used.dv_px)]
    enough = counts >= MIN_IN_CELL
    u, v = ((cells % columns) + 0.5) * size, ((cells // columns) + 0.5) * size
    return u[enough], v[enough], means[0][enough], means[1][enough]


def histogram_page(report, camera):
    title = f"{camera.name}: residual histogram"
    figure = page(title, "Both axes of all used corners against the normal distribution of the same robust width: heavier tails are "
                         "blurred or wrong corners.")
    left, right = panels(figure)[0]
    limit = 1.05 * max(shared_max(report, lambda other: np.abs(np.append(other.used.du_px, other.used.dv_px))), 1e-6)
    residuals = np.concatenate([camera.used.du_px, camera.used.dv_px])
    width = robust_width(camera)
    for axes, reach in ((left, 5.0 * max(robust_width(other) for other in report.cameras)), (right, limit)):
        edges = np.linspace(-reach, reach, 81)
        of_x, of_y = (histogram(values, edges) for values in (camera.used.du_px, camera.used.dv_px))
        steps(axes, edges, of_x, color=BLUE, label="x")
        steps(axes, edges, of_y, of_x, color=ORANGE, label="y")
        middle = np.linspace(-reach, reach, 400)
        expected = residuals.size * (edges[1] - edges[0]) * np.exp(-0.5 * (middle / width) ** 2) / (width * np.sqrt(2 * np.pi))
        axes.plot(middle, expected, color="black", linewidth=1.2, label=f"normal, stdev {width:.3f} px")
        axes.set_xlim(-reach, reach)
        axes.set_xlabel("residual (px)")
        axes.set_ylabel("corners")
    left.set_title("five stdevs" if len(report.cameras) == 1 else "five stdevs of the worst camera")
    left.legend()
    right.set_title("all, logarithmic: the tails")
    right.set_yscale("log")
    right.yaxis.set_major_formatter("{x:g}")
    right.yaxis.set_minor_locator(NullLocator())
    right.set_ylim(0.7, 2.0 * max((of_x + of_y).max(), 1.0))
    yield title, figure


def robust_width(camera):
    """The stdev of the normal distribution with the residuals' median size."""
    residuals = np.abs(np.append(camera.used.du_px, camera.used.dv_px))
    return max(1.4826 * float(np.median(residuals)), 1e-9) if residuals.size else 1e-9


def rms_page(report, camera):
    title = f"{camera.name}: rms by polar angle and by view"
    figure = page(title, "Residuals that grow with the angle: a model too simple, or blur at the edge. Single views that stand out: "
                         "motion blur, or a board that was bent or hidden.")
    left, right = panels(figure)[0]
    bands = [band for band in camera.statistics["bands"] if band["corners"]]
    starts = [band["from_deg"] for band in bands]
    left.bar(starts, [band["rms_px"] for band in bands], 10.0, align="edge", color=BLUE, edgecolor="white", label="rms")
    biases = camera.radial_biases
    middles = [0.5 * (bias["from_deg"] + bias["to_deg"]) for bias in biases]
    left.errorbar(middles, [bias["mean_px"] for bias in biases], [bias["stdev_px"] for bias in biases], color=RED, marker="o",
                  markersize=4, capsize=2, linewidth=1, label="mean outwards, with its stdev")
    left.axhline(0.0, color=GREY, linewidth=0.8)
    left.set_xlim(0, max(other.max_polar_deg for other in report.cameras) + 5.0)
    top = max(band["rms_px"] for other in report.cameras for band in other.statistics["bands"])
    bottom = min(bias["mean_px"] - bias["stdev_px"] for other in report.cameras for bias in [*other.radial_biases, NO_BIAS])
    left.set_ylim(1.1 * bottom, 1.2 * top)
    left.set_xlabel("angle from the optical axis (deg)")
    left.set_ylabel("residual (px)")
    left.legend()
    views, rms = rms_by_view(camera)
    right.vlines(report.times_s[views], 0, rms, color=BLUE, linewidth=0.8)
    right.plot(report.times_s[views], rms, ".", color=BLUE)
    right.set_ylim(0, 1.05 * max(rms_by_view(other)[1].max(initial=1e-9) for other in report.cameras))
    right.set_xlabel("time since the first view (s)")
    right.set_ylabel("rms of the view (px)")
    yield title, figure


def rms_by_view(camera):
    """Views with used corners, and the rms of their residuals."""
    views = camera.used.view.astype(int)
    squares = camera.used.du_px ** 2 + camera.used.dv_px ** 2
    counts = np.bincount(views)
    present = np.flatnonzero(counts)
    return present, np.sqrt(np.bincount(views, squares)[present] / counts[present])


def curves_page(report):
    title = "Distortion curves: angle to radius"
    figure = page(title, "Mean over all directions. Thick as far as there are corners, thin where the model is extrapolated; the "
                         "mark is the farthest used corner.")
    left, right = panels(figure)[0]
    for index, camera in enumerate(report.cameras):
        angle, radius = camera.curve.angle_deg, camera.curve.radius_px
        scale = image_scale(camera)
        colour = CYCLE[index % len(CYCLE)]
        known = angle <= camera.max_polar_deg
        for axes, values in ((left, radius), (right, scale)):
            axes.plot(angle, values, color=colour, linewidth=0.8)
            axes.plot(angle[known], values[known], color=colour, linewidth=2.2, label=f"{camera.name}, {camera.model}")
            axes.plot(camera.max_polar_deg, np.interp(camera.max_polar_deg, angle, values), "|", color=colour, markersize=22,
                      markeredgewidth=2)
    draw_known_lenses(left, report)
    reach = shared_max(report, lambda camera: camera.reach_deg + 5.0)
    for axes, label in ((left, "radius in the image (px)"), (right, "image scale along the radius (px/rad)")):
        axes.set_xlim(0, reach)
        axes.set_xlabel("angle from the optical axis (deg)")
        axes.set_ylabel(label)
    left.set_ylim(0, 1.05 * shared_max(report, lambda camera: np.interp(camera.reach_deg, camera.curve.angle_deg,
                                                                        camera.curve.radius_px)))
    right.set_ylim(0, 1.3 * shared_max(report, known_scale))
    left.legend(loc="lower right")
    yield title, figure


def draw_known_lenses(axes, report):
    """The curves of lenses that are as the first camera on the axis; a camera without corners has no curve."""
    camera = next((camera for camera in report.cameras if len(camera.curve.angle_deg) > 1), None)
    if camera is None:
        return
    scale, angle_rad = image_scale(camera)[0], np.radians(np.linspace(0, 180, 600))
    below = angle_rad < 0.49 * np.pi
    axes.plot(np.degrees(angle_rad[below]), scale * np.tan(angle_rad[below]), ":", color=GREY,
              label=f"without distortion (tan), as {camera.name}")
    axes.plot(np.degrees(angle_rad), scale * angle_rad, "--", color=GREY, linewidth=0.8, label=f"equidistant, as {camera.name}")


def image_scale(camera):
    """Pixels per radian along the radius, for all angles of the curve."""
    angle, radius = np.radians(camera.curve.angle_deg), camera.curve.radius_px
    return np.gradient(radius, angle) if len(angle) > 2 else np.zeros_like(radius)


def known_scale(camera):
    """The same as far as there are corners."""
    return image_scale(camera)[camera.curve.angle_deg <= camera.max_polar_deg]


def map_limits(report):
    """Whole decades around what the maps of all cameras show."""
    values = np.concatenate([column[camera.map.seen > 0] for camera in report.cameras
                             for column in (camera.map.stdev_px, camera.map.difference_px)])
    values = values[np.isfinite(values) & (values > 0)]
    if not values.size:
        return 1e-3, 1.0
    low, high = np.floor(np.log10(np.quantile(values, 0.02))), np.ceil(np.log10(np.quantile(values, 0.995)))
    return 10.0 ** low, 10.0 ** max(high, low + 1.0)


def shown_values(camera, column):
    values = np.ma.masked_invalid(camera.grid(column))
    return np.ma.masked_where(values.mask | (camera.grid("seen") == 0), values)


def is_crossed(shown, level):
    return bool(shown.count()) and shown.min() < level < shown.max()


def draw_map(axes, camera, column, title, norm):
    """A map of pixels over the image in colour, with contours and a thick line at 0.1 px."""
    image_axes(axes, camera, title)
    u, v = camera.grid("u_px"), camera.grid("v_px")
    shown = shown_values(camera, column)
    half_u, half_v = 0.5 * (u[0, 1] - u[0, 0]), 0.5 * (v[1, 0] - v[0, 0])
    image = cells(axes, shown, (u[0, 0] - half_u, u[0, -1] + half_u, v[-1, 0] + half_v, v[0, 0] - half_v), norm=norm, cmap=AMOUNTS)
    crossed = [level for level in MAP_LEVELS_PX if is_crossed(shown, level)]
    if crossed:
        axes.clabel(axes.contour(u, v, shown, crossed, colors="white", linewidths=0.7), fmt="%g px", fontsize=7)
    mark_fair(axes, u, v, shown)
    draw_ring(axes, camera)
    axes.grid(False)
    return image


def mark_fair(axes, u, v, shown):
    """The line at 0.1 px, with its number on top of the longest piece: matplotlib leaves short ones without."""
    if is_crossed(shown, FAIR_PX):
        longest = max(axes.contour(u, v, shown, [FAIR_PX], colors=RED, linewidths=2.0).allsegs[0], key=len)
        axes.text(*longest[np.argmin(longest[:, 1])], f"{FAIR_PX:g} px", color=RED, fontsize=7, ha="center", va="center",
                  bbox={"facecolor": "white", "edgecolor": "none", "pad": 1.0})


def maps_page(report, camera):
    title = f"{camera.name}: expected projection uncertainty, and odd against even views"
    columns = ["stdev_px"] + ([] if camera.median_difference_px is None else ["difference_px"])
    has_red = any(is_crossed(shown_values(camera, column), FAIR_PX) for column in columns)
    note = ("Left: standard deviation in the worst direction that the corners' noise leaves in the projection. Right: how far "
            "calibrations of the odd and of the even views are apart. Much more than noise lets expect is blur, rolling shutter, or a "
            f"model too simple. {'Red: 0.1 px. ' if has_red else ''}Dashed: the farthest used corner. White: no light or no model.")
    figure = image_page(title, note, camera)
    left, right = panels(figure)[0]
    norm = LogNorm(*map_limits(report), clip=True)
    image = draw_map(left, camera, "stdev_px", f"uncertainty, median {camera.median_stdev_px:.2g} px", norm)
    if camera.median_difference_px is None:
        right.axis("off")
        right.text(0.5, 0.5, "not measured: each half of the views\nmust determine a calibration", ha="center", va="center")
    else:
        draw_map(right, camera, "difference_px", f"odd against even, median {camera.median_difference_px:.2g} px, by noise "
                 f"{camera.median_expected_difference_px:.2g} px", norm)
    colour_bar(figure, image, [left, right], "pixels", extend="both")
    yield title, figure


def parts(report):
    """Generators of pages, of which none draws before it is asked."""
    for camera in report.cameras:
        yield coverage_page(report, camera)
        yield vectors_page(report, camera)
        yield histogram_page(report, camera)
        yield rms_page(report, camera)
    yield curves_page(report)
    for camera in report.cameras:
        yield maps_page(report, camera)
