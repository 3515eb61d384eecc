#!/usr/bin/python3
"""Draws report.pdf and report.html into a folder with the data that calibrate_cameras left there.

For its bar, the file `drawn` has the number of parts in its first line, and then a dot for each that is done.

Usage: draw_report.py <folder>
"""

import gc
import multiprocessing
import sys


def main(folder):
    try:
        import html_report
        import pdf_report
        from report_data import Report
    except ImportError as error:
        sys.exit(f"Python lacks {error.name}: install python3-matplotlib")
    gc.disable()  # a quarter of the time goes into looking for garbage, of which a report makes little
    report = Report(folder)
    drawn = open(report.folder / "drawn", "ab", buffering=0)  # both processes append to it
    drawn.write(b"%d\n" % (2 * len(pdf_report.parts(report))))
    report.part_done = lambda: drawn.write(b".")
    page = multiprocessing.Process(target=html_report.write, args=(report,))
    page.start()
    pdf_report.write(report)
    page.join()
    return page.exitcode


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__.strip())
    sys.exit(main(sys.argv[1]))
