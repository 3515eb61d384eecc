"""What the advice of the coverage node is worth."""

import statistics

from benchmarks.common import Failed, run, table, test_program

LENSES = [("ds-none", 195), ("ds-none", 120), ("pinhole-equi", 120), ("pinhole-radtan", 70)]
SEEDS = range(1, 11)


def advice(_):
    """Expected error of the projection after 12 random views and more: random ones, or where coverage_node says."""
    program = test_program("next_view")
    if program is None:
        raise Failed("next_view is not built: run scripts/build tests first")
    rows = []
    for model, field_of_view in LENSES:
        runs = [run(program, model, field_of_view, seed)[0].split() for seed in SEEDS]
        row = [f"{model}, {field_of_view} degrees"]
        row += [f"{statistics.median(float(numbers[column]) for numbers in runs):.3f}" for column in (1, 4, 5, 7, 8)]
        rows.append(row)
    table(["rms over the image [px]", "12 views", "18, random", "18, advised", "24, random", "24, advised"], rows)


EXPERIMENTS = {"advice": (advice, "")}
