"""Recordings of real lenses and boards; there is no truth, so the measures are published figures and held-out data."""

import csv
import gzip
import json
import os
import pathlib
import re

import numpy as np
import yaml

from benchmarks.common import (WORK, calibrate, camera, corners_per_image, difference, linked_folder, no_rounds, percent,
                               read_corners, rms, run, split_by_stamp, table, write_corners)
from benchmarks.residuals import residuals_px
from benchmarks.truth import board_point


def listed_corners(folder, path):
    """The other detector's corners that come with d435i_rgb, as a corner file; their places on the board tell their ids."""
    rows = []
    for file in sorted(folder.glob("*.csv")):
        with file.open() as lines:
            for line in csv.DictReader(lines):
                size, spacing = float(line["tag_size"]), float(line["tag_spacing"])
                # In units of half a pitch corners are at 0, 1.54, 2, 3.54, ... for a spacing of 0.3.
                col, row = (int(2 * float(line[axis]) / (size * (1 + spacing)) + 0.25) for axis in ("p_x", "p_y"))
                rows.append({"camera": 0, "stamp_ns": line["#ts"], "corner_id": 2 * int(line["tag_cols"]) * row + col,
                             "u_px": line["kp_x"], "v_px": line["kp_y"]})
    write_corners(path, ["# cam0 640 480 /cam0/image_raw"], rows)


def compare_with_list(data, record, found):
    """Corner files, as (label, path), and the list of d435i_rgb against the calibrated model."""
    target = yaml.safe_load((data / "target.yaml").read_text())
    listed = WORK / "d435i-listed.csv"
    listed_corners(data / "corners", listed)
    rows = []
    for label, path in [*found, ("the recording's list", listed)]:
        distances = np.array(list(residuals_px(record, path, lambda corner: board_point(target, corner)).values()))
        rows.append([label, len(read_corners(path)[1]), np.sum(distances > 1.0), f"{np.median(distances):.3f}"])
    table(["", "corners", "> 1 px from the calibrated model", "median distance [px]"], rows)


def d435i(settings):
    """Ordinary lens, colour JPEG, made a bag: pinhole-radtan from nothing."""
    folder = linked_folder("d435i", settings.data / "d435i_rgb" / "images")
    bag = WORK / "d435i.bag"
    run("make_bag", "--folder", folder, "--output-bag", bag)
    rows, found = [], []
    for label, flags in no_rounds("d435i"):
        chain, record, seconds = calibrate(WORK / "d435i", bag, settings.data / "d435i_rgb" / "target.yaml", ["pinhole-radtan"],
                                           ["/cam0/image_raw"], "--export-corners", *flags)
        corners = WORK / f"{label.replace(', ', '-').replace(' ', '-')}.csv"
        os.replace(WORK / "d435i-corners.csv", corners)
        found.append((label, corners))
        fu, fv = chain["cam0"]["intrinsics"][:2]
        rows.append([label, f"{rms(record):.3f}", f"{fu:.2f} ({percent(fu, 608.3)})", f"{fv:.2f} ({percent(fv, 610.9)})",
                     camera(record)["corners"]["used"], f"{seconds:.1f}"])
    table(["", "rms [px], asked <= 0.30", "fu [px], 608.3 within 1 %", "fv [px], 610.9 within 1 %", "corners", "time [s]"], rows)
    compare_with_list(settings.data / "d435i_rgb", record, found)


PUBLISHED_EUROC = [
    {"intrinsics": [458.654, 457.296, 367.215, 248.375], "distortion": [-0.28340811, 0.07395907, 0.00019359, 1.76187e-05]},
    {"intrinsics": [457.586, 456.134, 379.999, 255.238], "distortion": [-0.28368365, 0.07451284, -0.00010473, -3.555e-05]},
]


def euroc(settings):
    """Recorded corners of a stereo pair: trained on four of five views, checked on the fifth (poses only)."""
    rows = []
    for index in range(2):
        with gzip.open(settings.data / "euroc_corners" / f"cam{index}.csv.gz", "rt") as file:
            next(file)
            for stamp, tag, corner, u, v, *_ in csv.reader(file):
                row, col = divmod(int(tag), 6)
                corner_row, corner_col = divmod((0, 1, 3, 2)[int(corner)], 2)
                rows.append({"camera": index, "stamp_ns": stamp, "corner_id": (2 * row + corner_row) * 12 + 2 * col + corner_col,
                             "u_px": u, "v_px": v})
    rows.sort(key=lambda row: (row["camera"], int(row["stamp_ns"]), row["corner_id"]))
    comments = [f"# cam{index} 752 480 /cam{index}/image_raw" for index in range(2)]
    write_corners(WORK / "euroc.csv", comments, rows)
    split_by_stamp(WORK / "euroc.csv", WORK / "euroc-test.csv", WORK / "euroc-train.csv", lambda index: index % 5 == 4)
    target = settings.data / "euroc_corners" / "target.yaml"
    models, topics = ["pinhole-radtan"] * 2, ["/cam0/image_raw", "/cam1/image_raw"]
    chain, record, _ = calibrate(WORK / "euroc", WORK / "euroc.csv", target, models, topics)
    train, _, _ = calibrate(WORK / "euroc-train", WORK / "euroc-train.csv", target, models, topics)
    _, held_out, _ = calibrate(WORK / "euroc-test", WORK / "euroc-test.csv", target, models, topics, "--init",
                               WORK / "euroc-train-camchain.yaml", "--fix", "intrinsics", "--fix", "extrinsics")
    del train
    baseline = np.linalg.norm(np.array(chain["cam1"]["T_cn_cnm1"])[:3, 3])
    results = []
    for index in range(2):
        published = PUBLISHED_EUROC[index]["intrinsics"]
        found = chain[f"cam{index}"]["intrinsics"]
        results.append([f"cam{index} fu, fv [px]", f"{found[0]:.2f} ({percent(found[0], published[0])}), "
                        f"{found[1]:.2f} ({percent(found[1], published[1])})", f"{published[0]}, {published[1]} within 0.5 %"])
        results.append([f"cam{index} rms of the solve [px]", f"{rms(record, index):.3f}", ""])
        results.append([f"cam{index} rms held out [px]", f"{rms(held_out, index):.3f}", "<= 0.55"])
    results.append(["baseline [m]", f"{baseline:.5f}", "0.1101 within 0.001"])
    table(["figure", "reached", "asked"], results)
    publish_euroc_chain(chain)
    text, _ = run("compare_calibrations", WORK / "euroc-camchain.yaml", WORK / "euroc-published-camchain.yaml", "--corners",
                  WORK / "euroc.csv")
    print("Difference to the published projection where the recording has corners:\n\n```\n" + text.strip() + "\n```\n")
    check_euroc(target, topics)


def check_euroc(target, topics):
    """Whether it is the data or the fit that disagrees with the published calibration."""
    corners = WORK / "euroc.csv"
    halves = [WORK / "euroc-even.csv", WORK / "euroc-odd.csv"]
    split_by_stamp(corners, *halves, lambda index: index % 2 == 0)
    radtan = ["pinhole-radtan"] * 2
    cases = [("published lenses, poses and extrinsics only", corners, radtan,
              ["--init", WORK / "euroc-published-camchain.yaml", "--fix", "intrinsics"])]
    cases += [(f"{name} half of the views", half, radtan, []) for name, half in zip(["even", "odd"], halves)]
    cases += [(model, corners, [model] * 2, []) for model in ["pinhole-equi", "omni-radtan", "eucm-none", "ds-none"]]
    rows = []
    for label, source, models, flags in cases:
        own = WORK / f"euroc-check{len(rows)}.csv"
        own.write_text(source.read_text())
        chain, record, _ = calibrate(own.with_suffix(""), own, target, models, topics, *flags)
        row = [label, ", ".join(f"{rms(record, index):.3f}" for index in range(2)),
               ", ".join("({:.1f} {:.1f})".format(*chain[f"cam{index}"]["intrinsics"][-2:]) for index in range(2))]
        for other in ["euroc", "euroc-published"]:
            text, _ = run("compare_calibrations", f"{own.with_suffix('')}-camchain.yaml", WORK / f"{other}-camchain.yaml",
                          "--corners", corners)
            row.append(", ".join(f"{float(px):.2f}" for px in re.findall(r"differs by ([0-9.]+) px rms", text)))
        rows.append(row)
    table(["cam0, cam1 of", "rms [px]", "principal points [px]", "differ from ours by, rms [px]",
           "differ from the published ones by, rms [px]"], rows)


def publish_euroc_chain(chain):
    """The published calibration as a camchain; its extrinsics are not compared."""
    for index, published in enumerate(PUBLISHED_EUROC):
        chain[f"cam{index}"]["intrinsics"] = published["intrinsics"]
        chain[f"cam{index}"]["distortion_coeffs"] = published["distortion"]
    (WORK / "euroc-published-camchain.yaml").write_text(yaml.safe_dump(chain, default_flow_style=None))


def tumvi(settings):
    """Two 16-bit images of a 195-degree lens, from nothing and with its published double sphere (board poses only)."""
    folder = linked_folder("tumvi", settings.data / "tumvi_cam0" / "images")
    published = json.loads((settings.data / "tumvi_cam0" / "tumvi_512_ds_calib.json").read_text())
    half = published["value0"]["intrinsics"][0]["intrinsics"]
    full = [half["xi"], half["alpha"], 2 * half["fx"], 2 * half["fy"], (half["cx"] + 0.5) * 2 - 0.5, (half["cy"] + 0.5) * 2 - 0.5]
    chain = {"cam0": {"cam_overlaps": [], "camera_model": "ds", "distortion_coeffs": [], "distortion_model": "none",
                      "intrinsics": full, "resolution": [1024, 1024], "rostopic": "/cam0/image_raw"}}
    (WORK / "tumvi-published.yaml").write_text(yaml.safe_dump(chain, default_flow_style=None))
    known = ["--init", WORK / "tumvi-published.yaml", "--fix", "intrinsics"]
    rows = []
    for label, flags in [("published lens, round 0", [*known, "--max-rounds", "0"]), ("published lens, all rounds", known),
                         ("from nothing, round 0", ["--max-rounds", "0"]), ("from nothing, all rounds", [])]:
        _, record, _ = calibrate(folder, folder, settings.data / "tumvi_cam0" / "target.yaml", ["ds-none"], ["/cam0/image_raw"],
                                 *flags, "--export-corners")
        used = corners_per_image(pathlib.Path(f"{folder}-corners.csv"))
        rows.append([label, f"{rms(record):.3f}", ", ".join(map(str, used))])
    table(["", "rms [px], asked <= 0.15", "corners used in the two images of 144, asked >= 135, from nothing with all rounds >= 140"], rows)


def deltille(settings):
    """43 frames of a circular fisheye with a checkerboard; models of odd and even frames against each other."""
    folder = linked_folder("deltille", settings.data / "deltille_fisheye" / "cam0")
    # The board in the images has 8 x 11 inner corners; the recording's own file says 7 x 10.
    target = WORK / "deltille-target.yaml"
    target.write_text("target_type: 'checkerboard'\ntargetCols: 8\ntargetRows: 11\n"
                      "rowSpacingMeters: 0.02\ncolSpacingMeters: 0.02\n")
    rows = []
    for model in ["ds-none", "pinhole-equi"]:
        for label, flags in [*no_rounds(model), (f"{model}, all rounds, moving pupil", ["--estimate-pupil-shift"])]:
            name = "deltille-" + label.replace(", ", "-").replace(" ", "-")
            chain, record, seconds = calibrate(folder, folder, target, [model], ["/cam0/image_raw"], "--export-corners", *flags)
            del chain
            corners = WORK / f"{name}-corners.csv"
            os.replace(f"{folder}-corners.csv", corners)
            halves = [WORK / f"{name}-even.csv", WORK / f"{name}-odd.csv"]
            split_by_stamp(corners, *halves, lambda index: index % 2 == 0)
            for half in halves:
                calibrate(half.with_suffix(""), half, target, [model], ["/cam0/image_raw"], *[flag for flag in flags if flag == "--estimate-pupil-shift"])
            chains = [half.with_name(half.stem + "-camchain.yaml") for half in halves]
            region = ["--max-angle-deg", 180, "--corners", *halves]
            rows.append([label, f"{sum(count == 88 for count in corners_per_image(corners, used=False))} of 43",
                         f"{rms(record):.3f}", difference(*chains, *region), difference(*chains, *region, "--distance", 0.1),
                         f"{seconds:.1f}"])
    table(["", "images with the whole board, asked >= 38 (of detection)", "rms [px]", "odd against even, rms [px], asked <= 0.3, with the rounds 0.15",
           "the same at the board's distance [px]", "time [s]"], rows)


EXPERIMENTS = {
    "d435i": (d435i, "d435i_rgb"),
    "euroc": (euroc, "euroc_corners"),
    "tumvi": (tumvi, "tumvi_cam0"),
    "deltille": (deltille, "deltille_fisheye"),
}
