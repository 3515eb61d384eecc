"""Where the time goes: round 0, the later rounds and the solves, beside what other detectors need to detect."""

import re

from benchmarks.common import Stopwatch, run, table
from benchmarks.detectors import PEERS, RECORDINGS

MAX_ROUNDS_RATIO = 1.5  # all later rounds against round 0
NUM_REPEATS = 3  # the fastest run counts: whatever else the machine does only adds


def fastest_run(recording, *flags):
    """(processor time [s], wall time [s], output) from the start of the program until the results are written."""
    bag, target, _ = recording.files
    results = []
    for _ in range(NUM_REPEATS):
        with Stopwatch() as watch:
            text, _ = run("calibrate_cameras", "--bag", bag, "--target", target, "--models", "ds-none", "--topics",
                          "/cam0/image_raw", "--no-report", "--verbose", *flags)
        results.append((watch.cpu_s, watch.wall_s, text))
    return min(results)


def rounds_s(recording):
    """Time of each round on one thread, and of each solve, from the steps that one run prints; round 0 has the rest of the run."""
    _, wall_s, text = fastest_run(recording, "--threads", "1")
    steps = [(float(seconds), step) for seconds, step in re.findall(r"^ +([0-9.]+) s  (.+)$", text, re.MULTILINE)]
    rounds = [0.0]
    for seconds, step in steps:
        rounds += [0.0] if step.startswith("recover") else []
        rounds[-1] += seconds
    rounds[0] += wall_s - sum(rounds)
    return rounds, [seconds for seconds, step in steps if step == "solve"]


def one_thread(recording):
    rounds, solves = rounds_s(recording)
    rows = [[f"round {number}", f"{seconds:.2f}", f"{10 * seconds:.1f}"] for number, seconds in enumerate(rounds)]
    rows.append([f"later rounds / round 0, asked <= {MAX_ROUNDS_RATIO}", f"{sum(rounds[1:]) / rounds[0]:.2f}", ""])
    rows.append([f"the {len(solves)} solves in these", f"{sum(solves):.2f}", f"{10 * sum(solves):.1f}"])
    for detector in PEERS:
        found = detector(recording)
        rows.append([f"detection alone: {detector.title}", f"{found.cpu_s:.2f}", f"{found.median_ms:.1f} (median)"])
    return rows


def time(_):
    """Round 0, the later rounds and the solves on one thread; whole runs on all; what other detectors need to detect."""
    for recording in RECORDINGS:
        print(f"**{recording.name}**: {recording.title}, 100 frames; fastest of {NUM_REPEATS} runs.\n")
        table(["one thread", "[s]", "per frame [ms]"], one_thread(recording))
        whole = [("round 0", fastest_run(recording, "--max-rounds", 0)), ("all rounds", fastest_run(recording))]
        table(["whole run until the results are written, all cores", "wall [s]", "processor [s]"],
              [[title, f"{wall_s:.2f}", f"{cpu_s:.2f}"] for title, (cpu_s, wall_s, _) in whole])


EXPERIMENTS = {"time": (time, "")}
