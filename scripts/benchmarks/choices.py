"""Figures behind what docs/recording.md advises and docs/decisions.md decides."""

import re
import shutil

import numpy as np

from benchmarks.common import WORK, calibrate, camera, difference, rms, run, table
from benchmarks.detectors import RECORDINGS, ours
from benchmarks.truth import Score, Truth, read_poses

TOPIC = "/cam0/image_raw"
MODEL = "pinhole-radtan"
RIM_DEG = (80, 100)


def ordinary():
    """Images of a 70-degree lens with truth, as a folder; rendered once."""
    folder = WORK / "ordinary"
    if not folder.exists():
        run("simulate", "--lens", "pinhole70", "--models", MODEL, "--views", 300, "--seed", 3, "--noise", 4, "--output-dir", folder)
    return folder, WORK / "ordinary-target.yaml"


def linked(name, images):
    """A recording of some images of another."""
    folder = WORK / name / "cam0"
    folder.mkdir(parents=True, exist_ok=True)
    for image in images:
        link = folder / image.name
        if not link.exists():
            link.symlink_to(image)
    return folder.parent


def tilts(_):
    """How certain 30 views make a 70-degree lens, by the tilt of the board against the image."""
    folder, target = ordinary()
    poses = read_poses(WORK / "ordinary-truth-poses.csv")
    tilt_deg = {stamp: np.degrees(np.arccos(abs(R[2, 2]))) for stamp, (R, _) in poses.items()}
    images = sorted((folder / "cam0").iterdir(), key=lambda image: tilt_deg[int(image.stem)])
    rows = []
    for name, chosen in [("frontal", images[:30]), ("all tilts", images[::10])]:
        bag = linked(f"tilts-{name.replace(' ', '-')}", chosen)
        text, _ = run("calibrate_cameras", "--bag", bag, "--target", target, "--topics", TOPIC, "--models", MODEL)
        spread = [tilt_deg[int(image.stem)] for image in chosen]
        stdev = re.search(r"projection: \[.*?\] \+- \[\s*([0-9.]+)", text, re.DOTALL).group(1)
        rows.append([name, f"{min(spread):.0f} to {max(spread):.0f}", f"{float(stdev):.2f}",
                     re.search(r"projection certain to (?:better than )?([0-9.]+) px", text).group(1)])
    table(["30 views", "tilt [degrees]", "stdev of fu [px]", "uncertainty of the projection, median [px]"], rows)


def jpeg(_):
    """What compression to JPEG costs."""
    from PIL import Image  # python3-pil, which nothing else here needs

    folder, target = ordinary()
    images = sorted((folder / "cam0").iterdir())[::5]
    rows = []
    for quality in [None, 90, 50]:
        bag = WORK / f"jpeg-{quality}"
        (bag / "cam0").mkdir(parents=True, exist_ok=True)
        for image in images:
            if quality is None:
                shutil.copy(image, bag / "cam0")
            else:
                Image.open(image).save(bag / "cam0" / f"{image.stem}.jpg", quality=quality)
        _, record, _ = calibrate(bag, bag, target, [MODEL], [TOPIC])
        rows.append(["PNG" if quality is None else f"JPEG, quality {quality}", camera(record)["corners"]["used"], f"{rms(record):.3f}",
                     difference(f"{bag}-camchain.yaml", WORK / "ordinary-truth-camchain.yaml")])
    table(["60 images", "corners", "residuals, rms [px]", "true error of the projection, rms [px]"], rows)


def filters(_):
    """The test of predicted corners in the image against the paper's on quadrilaterals."""
    recording = RECORDINGS[0]
    truth = Truth(recording)
    rim = truth.asked_within(RIM_DEG)
    rows = []
    for label, key, flags in [("image", "rounds", []), ("quads", "quads", ["--corner-filter", "quads"])]:
        found = ours(recording, key, *flags)
        score = Score(truth, found.corners)
        rows.append([label, *(f"{100.0 * np.sum(score.found & asked) / np.sum(asked):.1f}" for asked in (truth.asked, rim)),
                     score.num_false, f"{found.wall_s:.1f}"])
    table([f"{recording.name}, --corner-filter", "found [%]", "found from 80 degrees on [%]", "hidden, absent or > 2 px off", "whole run [s]"],
          rows)


EXPERIMENTS = {"tilts": (tilts, ""), "jpeg": (jpeg, ""), "filters": (filters, "")}
