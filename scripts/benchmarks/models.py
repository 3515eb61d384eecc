"""Lens models fitted to the corners of round 0 and of all rounds: table IV of the paper, with the true error beside the residuals."""

from benchmarks.common import camera, difference, rms, table
from benchmarks.detectors import RECORDINGS, ours

MODELS = ["ds-none", "omni-radtan", "pinhole-equi", "eucm-none"]


def row(recording, model, title, key, flags):
    found = ours(recording, f"{model}-{key}", *flags, model=model)
    truth = recording.files[2]
    return [f"{model}, {title}", camera(found.record)["corners"]["used"], f"{rms(found.record):.4f}",
            difference(found.camchain, truth, "--max-angle-deg", recording.edge_deg)]


def models(_):
    """Residuals and true error of four lens models, fitted to the corners of round 0 and of all rounds."""
    for recording in RECORDINGS:
        print(f"**{recording.name}**: {recording.title}; it is a double sphere.\n")
        table(["model", "corners used", "residuals, rms [px]", f"true error to {recording.edge_deg:g} degrees, rms [px]"],
              [row(recording, model, title, key, flags) for model in MODELS
               for title, key, flags in [("round 0", "round0", ["--max-rounds", "0"]), ("all rounds", "rounds", [])]])


EXPERIMENTS = {"models": (models, "")}
