"""BabelCalib's OV-plane recording: another detector's corners refined by symmetry, checked on views that the lens was not fitted to."""

import csv

import numpy as np

from benchmarks.common import WORK, Failed, calibrate, run, table, test_program, write_corners
from benchmarks.residuals import residuals_px

MODEL = "pinhole-equi"
TOPIC = "/cam0/image_raw"
CORNERS = 22  # along each side
PITCH_M = 0.0075
MAX_RESIDUAL_PX = 3.0
HELD_OUT_RMS_PX = 0.46
PARTS = ("train", "test")


def corner_ids(board):
    """Our ids in the order of the board's file, whose rows are tag, column, row, x, y, z: ours count rows along x."""
    with board.open() as file:
        rows = list(csv.reader(file))[2:]
    return [int(row[1]) * CORNERS + int(row[2]) for row in rows]


def load(folder, images, ids):
    """Links the images of one part under stamps, and returns its corners with these stamps as the rows of a corner file."""
    images.mkdir(parents=True, exist_ok=True)
    rows = []
    for index, path in enumerate(sorted(folder.glob("*.orpc"))):
        stamp = 1_000_000_000 * (index + 1)
        link = images / f"{stamp}.png"
        if not link.exists():
            link.symlink_to(path.with_suffix(".png").resolve())
        lines = [line.split(",") for line in path.read_text().splitlines() if line[:1].isdigit()]
        found = sorted((ids[int(line[1])], line[3], line[4]) for line in lines)
        rows += [{"camera": 0, "stamp_ns": stamp, "corner_id": corner, "u_px": u, "v_px": v} for corner, u, v in found]
    return rows


def board_point(corner):
    return PITCH_M * np.array([*divmod(corner, CORNERS), 0.0])


def held_out_residuals(train, test, target):
    """Fits the lens to one corner file, the board's poses to the other, and returns residuals_px of that."""
    calibrate(train.with_suffix(""), train, target, [MODEL], [TOPIC])
    _, record, _ = calibrate(test.with_suffix(""), test, target, [MODEL], [TOPIC], "--init",
                             train.with_name(f"{train.stem}-camchain.yaml"), "--fix", "intrinsics")
    return residuals_px(record, test, board_point)


def figures(residuals):
    """Rms of those below the limit, as everywhere with these data, and how many are above."""
    values = np.array(residuals)
    near = values[values < MAX_RESIDUAL_PX]
    return [f"{np.sqrt(np.mean(near ** 2)):.3f}", f"{np.median(values):.3f}", f"{len(near)}, {len(values) - len(near)}"]


def ov_plane(settings):
    """Deltille's corners of 18 + 7 images of a checkerboard, refined by symmetry: held-out residuals of pinhole-equi."""
    refiner = test_program("refine_corners")
    if refiner is None:
        raise Failed("refine_corners is not built: run scripts/build tests first")
    folder = settings.data / "ov_plane"
    target = WORK / "ov_plane-target.yaml"
    target.write_text(f"target_type: 'checkerboard'\ntargetCols: {CORNERS}\ntargetRows: {CORNERS}\n"
                      f"rowSpacingMeters: {PITCH_M}\ncolSpacingMeters: {PITCH_M}\n")
    ids = corner_ids(folder / "ov_plane.dsc")
    given, refined = ({part: WORK / f"ov_plane-{part}{suffix}.csv" for part in PARTS} for suffix in ("", "-refined"))
    for part in PARTS:
        rows = load(folder / "corners" / part, WORK / f"ov_plane-{part}" / "cam0", ids)
        write_corners(given[part], [f"# cam0 1280 800 {TOPIC}"], rows)
    before = held_out_residuals(given["train"], given["test"], target)
    for part in PARTS:
        run(refiner, WORK / f"ov_plane-{part}", given[part], target, WORK / "ov_plane-train-camchain.yaml", refined[part])
    after = held_out_residuals(refined["train"], refined["test"], target)
    table(["corners of the 7 views held out", f"rms [px], asked <= {HELD_OUT_RMS_PX}", "median [px]",
           f"below {MAX_RESIDUAL_PX:g} px, above"],
          [["Deltille's", *figures(list(before.values()))],
           ["Deltille's, of those that were refined", *figures([before[key] for key in after])],
           ["refined by symmetry", *figures(list(after.values()))]])


EXPERIMENTS = {"ovplane": (ov_plane, "ov_plane")}
