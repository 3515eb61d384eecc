"""report.pdf: the verdict, Kalibr's pages, and ours."""

import frame_pages
import kalibr_pages
import matplotlib.pyplot as plt
import quality_pages
from matplotlib.backends.backend_pdf import PdfPages

RASTER_DPI = 130  # of the pictures


def parts(report):
    return [frame_pages.verdict_page(report), *kalibr_pages.parts(report), *quality_pages.parts(report), *frame_pages.parts(report)]


def pages(report):
    for part in parts(report):
        yield from part
        report.part_done()


def write(report):
    with PdfPages(report.folder / "report.pdf", metadata={"Title": f"Calibration of {report.name}"}) as pdf:
        for _, figure in pages(report):
            pdf.savefig(figure, dpi=RASTER_DPI)
            plt.close(figure)
