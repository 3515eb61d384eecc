"""How many of the corners that are to be seen each detector finds, and how many that are not: tables I and II of the paper."""

import numpy as np

from benchmarks.common import Failed, read_corners, table
from benchmarks.detectors import RECORDINGS, available
from benchmarks.truth import MAX_ERROR_PX, Score, Truth, bands


def resolution(path):
    """Width and height in the first line of a corner file."""
    comments, _ = read_corners(path)
    if not comments or len(comments[0].split()) != 5:
        raise Failed(f"{path} does not begin with '# cam0 <width> <height> <topic>', as corner files do")
    return comments[0].split()[2:4]


def scores(recording, truth, peers):
    """(title, Score) of each detector; of the peers those whose images have the recording's size."""
    result = [(detector.title, Score(truth, detector(recording).corners)) for detector in available()]
    expected = resolution(truth.corners_path)
    return [*result, *((name, Score(truth, path)) for name, path in peers.items() if resolution(path) == expected)]


def share(count, total):
    return f"{count} ({100.0 * count / max(1, total):.1f} %)"


def band_share(score, truth, band):
    inside = truth.asked_within(band)
    return f"{100.0 * np.sum(score.found & inside) / np.sum(inside):.1f}"


def features(settings):
    """Corners that each detector finds of those to be seen, in all and by polar angle, and how many it invents."""
    for recording in RECORDINGS:
        truth = Truth(recording)
        print(f"**{recording.name}**: {recording.title}, 100 frames.\n")
        rows = scores(recording, truth, settings.peers)
        table(["detector", f"found, of {np.sum(truth.asked)}", f"false: hidden, absent, > {MAX_ERROR_PX:g} px off",
               "share of what it reports [%]"],
              [[title, share(np.sum(score.found), np.sum(truth.asked)),
                f"{score.num_false}: {score.num_hidden}, {score.num_absent}, {score.num_off}", f"{100.0 * score.false_ratio:.2f}"]
               for title, score in rows])
        columns = bands(truth.polar_deg[truth.asked].max())
        table(["found [%] by polar angle [degrees]", *(f"{start}-{to}" for start, to in columns)],
              [["corners to be seen", *(np.sum(truth.asked_within(band)) for band in columns)],
               *([title, *(band_share(score, truth, band) for band in columns)] for title, score in rows)])


EXPERIMENTS = {"features": (features, "")}
