"""The paper's plots; apart from what draws them, so that only those who want plots need matplotlib."""

from benchmarks.common import WORK, Failed


def plots(settings):
    """PNG files: corners over polar angle and azimuth, detection rate by polar angle, cost of the symmetric refinement."""
    try:
        from benchmarks import figures
    except ImportError as error:
        raise Failed(f"{error}: install python3-matplotlib, python3-opencv and python3-rosbag") from error
    print(f"In {WORK}:\n")
    figures.draw(settings)
    print()


EXPERIMENTS = {"plots": (plots, "")}
