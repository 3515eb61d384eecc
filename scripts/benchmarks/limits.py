"""The numbers that this tool has to reach on rendered recordings, each with what it reaches."""

import numpy as np

from benchmarks.common import difference, table
from benchmarks.detectors import PEERS, RECORDINGS, ours
from benchmarks.timing import fastest_run
from benchmarks.truth import Score, Truth

BLURRED_PX = 0.5  # frames whose corners move less during the exposure, in the median, count as sharp


def rms(values):
    return np.sqrt(np.mean(np.square(values)))


def found_rate(truth, score, start_deg, end_deg):
    inside = truth.asked_within((start_deg, end_deg))
    return 100.0 * np.sum(score.found & inside) / np.sum(inside)


def is_blurred(truth):
    """Of each corner of the truth, whether its frame is blurred by motion."""
    blurred = {stamp: np.median(truth.motion_px[truth.stamp_ns == stamp]) > BLURRED_PX for stamp in np.unique(truth.stamp_ns)}
    return np.array([blurred[stamp] for stamp in truth.stamp_ns])


def accuracy(truth, score):
    """(what, asked, reached) of the errors of the corners found."""
    blurred, error_px = is_blurred(truth)[score.found_row], score.found_error_px
    ratio = score.found_bound_ratio
    return [("error of sharp frames / sqrt(trace) of the corner's Cramer-Rao bound, median (best possible: 0.83)", "<= 1.3", f"{np.median(ratio[~blurred]):.2f}"),
            ("error of all frames, median, rms [px]", "<= 0.025, 0.06", f"{np.median(error_px):.4f}, {rms(error_px):.4f}"),
            ("error of frames blurred by motion, median [px]", "<= 0.05", f"{np.median(error_px[blurred]):.4f}")]


def speed(recording):
    cpu_s, wall_s, _ = fastest_run(recording)
    apriltag_s = PEERS[0](recording).cpu_s
    return [("whole run with all rounds, wall (processor) [s]", f"<= 5 and libapriltag's detection, {apriltag_s:.2f}",
             f"{wall_s:.2f} ({cpu_s:.2f})")]


def limits(_):
    """The figures asked of the default settings, beside those reached."""
    for recording in RECORDINGS:
        truth = Truth(recording)
        found = ours(recording, "rounds")
        score = Score(truth, found.corners)
        edge_deg = min(recording.edge_deg, 95)
        ranges = [(0, 90, 98), (90, 97.5, 95)][:2 if recording.edge_deg > 90 else 1]
        rows = [*((f"corners found from {start:g} to {end:g} degrees [%]", f">= {asked}", f"{found_rate(truth, score, start, end):.1f}")
                  for start, end, asked in ranges),
                ("reported that are hidden, absent or > 2 px off [%]", "<= 0.1", f"{100.0 * score.false_ratio:.2f}"),
                *accuracy(truth, score),
                (f"true error of the model to {edge_deg:g} degrees, rms [px]", "<= 0.03",
                 difference(found.camchain, recording.files[2], "--max-angle-deg", edge_deg)),
                *speed(recording)]
        print(f"**{recording.name}**: {recording.title}.\n")
        table(["what", "asked", "reached"], rows)


EXPERIMENTS = {"limits": (limits, "")}
