"""report.pdf: the verdict, Kalibr's pages, and ours."""

import frame_pages
import kalibr_pages
import matplotlib.pyplot as plt
import quality_pages
from matplotlib.backends.backend_pdf import PdfPages

RASTER_DPI = 130  # of points too many for vectors


def pages(report):
    yield from frame_pages.verdict_page(report)
    yield from kalibr_pages.pages(report)
    yield from quality_pages.pages(report)
    yield from frame_pages.pages(report)


def write(report):
    with PdfPages(report.folder / "report.pdf", metadata={"Title": f"Calibration of {report.name}"}) as pdf:
        for _, figure in pages(report):
            pdf.savefig(figure, dpi=RASTER_DPI)
            plt.close(figure)
