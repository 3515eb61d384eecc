"""The paper's plots, as PNG files in build/benchmark: where corners are found, and why the symmetry of a wide window fails."""

import matplotlib

matplotlib.use("Agg")  # no display

import cv2
import matplotlib.pyplot as plt
import numpy as np
import yaml
from PIL import Image

from benchmarks.common import WORK
from benchmarks.detect_aruco import images
from benchmarks.detectors import RECORDINGS, available, ours
from benchmarks.features import scores
from benchmarks.truth import Score, Truth, bands, board_point, project

# Okabe and Ito's colours, which colour-blind readers can tell apart; markers tell the curves apart without them.
COLOURS = ["#000000", "#E69F00", "#56B4E9", "#009E73", "#D55E00", "#0072B2", "#CC79A7"]
MARKERS = "sD^ovPX"
DPI = 100
NUM_COLOURS = 128  # of the file: enough for lines and maps, and a third of the bytes


def save(figure, name):
    path = WORK / f"{name}.png"
    figure.savefig(path, dpi=DPI)
    plt.close(figure)
    with Image.open(path) as image:
        reduced = image.convert("RGB").quantize(NUM_COLOURS)
    reduced.save(path, optimize=True)
    print(f"* `{path.name}`")


def plain(title):
    """A title of the tables without their marks for code."""
    return title.replace("`", "")


def plot_rates(settings):
    """Share of the corners to be seen that each detector finds, by polar angle."""
    figure, axes = plt.subplots(1, len(RECORDINGS), figsize=(11, 4.8), sharey=True)
    for axis, recording in zip(axes, RECORDINGS):
        truth = Truth(recording)
        columns = bands(truth.polar_deg[truth.asked].max())
        inside = [truth.asked_within(band) for band in columns]
        for (title, score), colour, marker in zip(scores(recording, truth, settings.peers), COLOURS, MARKERS):
            rates = [100.0 * np.sum(score.found & band) / np.sum(band) for band in inside]
            axis.plot([np.mean(band) for band in columns], rates, color=colour, marker=marker, label=plain(title))
        axis.set(title=f"{recording.name}: {recording.title}", xlabel="polar angle [degrees], bands of 10", ylim=(-3, 103))
        axis.grid(alpha=0.3)
    axes[0].set_ylabel("found of the corners to be seen [%]")
    handles, labels = axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="lower center", ncol=3, frameon=False)
    figure.tight_layout(rect=(0, 0.13, 1, 1))
    save(figure, "rate_by_polar_angle")


def plot_scatter(recording):
    """Corners over polar angle (radius) and azimuth, a panel for each detector."""
    truth = Truth(recording)
    detectors = [detector for detector in available() if np.any(Score(truth, detector(recording).corners).found)]
    columns = (len(detectors) + 1) // 2
    figure, axes = plt.subplots(2, columns, figsize=(3.4 * columns, 7.8), subplot_kw={"projection": "polar"})
    for axis in axes.flat[len(detectors):]:
        axis.remove()
    for axis, detector in zip(axes.flat, detectors):
        found = Score(truth, detector(recording).corners).found
        missed = truth.asked & ~found
        for mask, colour, label in [(missed, "#D55E00", "missed"), (found, "#0072B2", "found")]:
            axis.scatter(np.radians(truth.azimuth_deg[mask]), truth.polar_deg[mask], s=2, color=colour, linewidths=0, label=label)
        axis.set_title(f"{plain(detector.title)}\n{np.sum(found)} of {np.sum(truth.asked)}", fontsize=10)
        axis.set_theta_direction(-1)  # as in the image, where y points down
        axis.set_rlabel_position(45)
        axis.set_ylim(0, recording.edge_deg)
        axis.set_rgrids(range(30, int(recording.edge_deg), 30), fontsize=9, fontweight="bold",
                        bbox={"facecolor": "white", "edgecolor": "none", "pad": 1})
        axis.set_thetagrids(range(0, 360, 90), fontsize=9)
    handles, labels = axes.flat[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="lower center", ncol=2, frameon=False, markerscale=6)
    figure.suptitle(f"{recording.name}: polar angle (radius) and azimuth of the corners to be seen")
    figure.tight_layout(rect=(0, 0.04, 1, 0.99))
    save(figure, f"scatter_{recording.name}")


PAPER_WINDOW = 0.3  # half the window in which the paper samples [tag sides]
OUR_WINDOW = 0.18  # ours for a border of two cells, of which the default is 0.9
SAMPLES = 24  # along half a window
SEARCH_PX = 2.5


def asymmetry(image, camera, T_cam_target, point, half_window, centres):
    """Rms difference [grey levels] between the points of a window on the board and their mirror images in its centre, as a
    function of where in the image that centre is assumed; sampled through the true lens."""
    steps = np.linspace(-half_window, half_window, 2 * SAMPLES)
    offsets = np.array([[x, y, 0.0] for x in steps for y in steps if y > 0])
    origin = project(camera, T_cam_target, point[None])
    pixels = [project(camera, T_cam_target, point + sign * offsets) - origin for sign in (1, -1)]
    values = [cv2.remap(image, *(np.add.outer(centres[:, k], part[:, k]).astype(np.float32) for k in (0, 1)), cv2.INTER_LINEAR)
              for part in pixels]
    return np.sqrt(np.mean((values[0] - values[1]) ** 2, axis=1))


def plot_symmetry(recording, stamp_ns, corner_id):
    """The cost of the symmetric refinement around one corner: the paper's window reaches into the payload, ours does not."""
    truth = Truth(recording)
    bag, target_path, camchain = recording.files
    target = yaml.safe_load(target_path.read_text())
    camera = yaml.safe_load(camchain.read_text())["cam0"]
    image = next(gray for stamp, gray in images(bag) if stamp == stamp_ns).astype(np.float32)
    row = truth.row_of[(stamp_ns, corner_id)]
    place, T_cam_target, point = truth.px[row], truth.T_cam_target[stamp_ns], board_point(target, corner_id)
    ticks = np.linspace(-SEARCH_PX, SEARCH_PX, 101)
    centres = place + np.array([[u, v] for v in ticks for u in ticks])
    figure, axes = plt.subplots(1, 3, figsize=(12.5, 4.4))
    axes[0].imshow(image, cmap="gray", vmin=0, vmax=255)
    for axis, window, colour, title in [(axes[1], PAPER_WINDOW, "#E69F00", "the paper's window, ±0.3 tag"),
                                        (axes[2], OUR_WINDOW, "#56B4E9", "this window, ±0.18 tag")]:
        half = window * target["tagSize"]
        outline = project(camera, T_cam_target, point + half * np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0], [-1, -1, 0]]))
        axes[0].plot(*outline.T, color=colour, label=title)
        cost = asymmetry(image, camera, T_cam_target, point, half, centres).reshape(len(ticks), -1)
        shown = axis.imshow(cost, cmap="viridis", extent=[-SEARCH_PX, SEARCH_PX, SEARCH_PX, -SEARCH_PX])
        best = centres[np.argmin(cost)] - place
        axis.plot(0, 0, "+", color="white", markersize=16, markeredgewidth=2, label="true corner")
        axis.plot(*best, "o", color="#D55E00", markeredgecolor="white", label=f"minimum, {np.hypot(*best):.2f} px off")
        axis.set_title(title, fontsize=11)
        axis.set(xlabel="u from the true corner [px]", ylabel="v from the true corner [px]")
        axis.legend(loc="lower right", fontsize=8)
        figure.colorbar(shown, ax=axis, label="rms asymmetry [grey levels]", shrink=0.85)
    reach = 1.6 * np.max(np.abs(axes[0].lines[0].get_xydata() - place))
    axes[0].set(xlim=(place[0] - reach, place[0] + reach), ylim=(place[1] + reach, place[1] - reach), xlabel="u [px]", ylabel="v [px]",
                title=f"corner {corner_id}, {truth.polar_deg[row]:.0f}° from the axis")
    axes[0].legend(loc="lower left", fontsize=8)
    figure.tight_layout()
    save(figure, "symmetry_cost")


CROP_PX = 12  # around a missed corner
CROP_COLUMNS = 9
MAX_CROPS = 4 * CROP_COLUMNS


def plot_missed(recording):
    """Pictures of corners that all rounds miss, spread over the polar angle."""
    truth = Truth(recording)
    missed = np.flatnonzero(truth.asked & ~Score(truth, ours(recording, "rounds").corners).found)
    missed = missed[np.argsort(-truth.polar_deg[missed])]
    if len(missed) == 0:
        return
    shown = missed[np.unique(np.linspace(0, len(missed) - 1, MAX_CROPS).astype(int))]
    stamps = set(truth.stamp_ns[shown].tolist())
    pictures = {stamp: gray for stamp, gray in images(recording.files[0]) if stamp in stamps}
    num_rows = -(-len(shown) // CROP_COLUMNS)
    figure, axes = plt.subplots(num_rows, CROP_COLUMNS, figsize=(12, 0.5 + 1.5 * num_rows))
    for axis in axes.flat:
        axis.axis("off")
    for axis, row in zip(axes.flat, shown):
        u, v = truth.px[row]
        axis.imshow(pictures[truth.stamp_ns[row]], cmap="gray")
        axis.plot(u, v, "o", markersize=14, markerfacecolor="none", markeredgecolor="#E69F00", markeredgewidth=1.5)
        axis.set(xlim=(u - CROP_PX, u + CROP_PX), ylim=(v + CROP_PX, v - CROP_PX))
        axis.set_title(f"{truth.polar_deg[row]:.0f}°, {truth.motion_px[row]:.1f} px", fontsize=9)
    figure.suptitle(f"{recording.name}: {len(missed)} corners missed by all rounds ({len(shown)} shown); polar angle, motion "
                    "during the exposure")
    figure.tight_layout()
    save(figure, f"missed_{recording.name}")


def draw(settings):
    plot_rates(settings)
    for recording in RECORDINGS:
        plot_scatter(recording)
        plot_missed(recording)
    plot_symmetry(RECORDINGS[0], 1600000000250000000, 109)
