"""report.html: the pages as pictures, a table of the views, and the frames with their corners, in one file."""

import base64
import html
import json
import struct
import zlib
from pathlib import Path

import frame_pages
import matplotlib.pyplot as plt
import numpy as np
import pdf_report

PAGE_DPI = 90
TEMPLATE = Path(__file__).parent / "report_template.html"


def data_url(content, kind):
    return f"data:image/{kind};base64,{base64.b64encode(content).decode('ascii')}"


def pages_html(report):
    parts = []
    for index, (title, figure) in enumerate(pdf_report.pages(report)):
        if title not in ("Verdict", "Calibration results"):  # which the page shows as text
            heading = html.escape(title)
            parts.append(f'<figure id="page{index}"><img alt="{heading}" src="{data_url(picture_of(figure), "png")}"></figure>')
        plt.close(figure)
    return "\n".join(parts)


def picture_of(figure):
    """The page as PNG. Without filters zlib's fastest level takes a third of Pillow's time, for as many bytes."""
    figure.set_dpi(PAGE_DPI)
    figure.canvas.draw()
    rgb = np.asarray(figure.canvas.buffer_rgba())[..., :3]
    height, width, channels = rgb.shape
    rows = np.zeros((height, 1 + width * channels), np.uint8)  # a row begins with the number of its filter: none
    rows[:, 1:] = rgb.reshape(height, -1)
    header = struct.pack(">2I5B", width, height, 8, 2, 0, 0, 0)  # bits of a channel, kind RGB, the only methods there are
    chunks = ((b"IHDR", header), (b"IDAT", zlib.compress(rows.tobytes(), 1)), (b"IEND", b""))
    return b"\x89PNG\r\n\x1a\n" + b"".join(
        struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data)) for kind, data in chunks)


def verdict_html(report):
    verdict = report.verdict
    lines = [f"<li>{html.escape(fact)}</li>" for fact in verdict["facts"]]
    lines += [f'<li class="{reason["grade"]}">{reason["grade"]}: {html.escape(reason["text"])}</li>'
              for reason in verdict["reasons"]]
    if not verdict["reasons"]:
        lines.append('<li class="good">Nothing speaks against this calibration.</li>')
    lines += [f"<li>note: {html.escape(warning)}</li>" for warning in report.warnings]
    return f'<p id="verdict" class="{verdict["grade"]}">Verdict: {verdict["grade"]}</p>\n<ul>{"".join(lines)}</ul>'


def summary_html(report):
    def line(kind, texts):
        return f"<tr>{''.join(f'<{kind}>{html.escape(str(text))}</{kind}>' for text in texts)}</tr>"

    columns, rows = frame_pages.summary(report)
    body = "".join(line("td", row) for row in rows)
    return f'<div class="wide"><table id="summary"><thead>{line("th", columns)}</thead><tbody>{body}</tbody></table></div>'


def rounded(values, digits):
    """Numbers as JSON with few digits; what is not finite becomes null."""
    rounded_values = np.round(np.asarray(values, dtype=float), digits)
    return [value if finite else None for value, finite in zip(rounded_values.tolist(), np.isfinite(rounded_values).tolist())]


def corners_of(table):
    """u, v and residual of one view's corners, one list for each."""
    residuals = (table.du_px, table.dv_px) if hasattr(table, "du_px") else ()
    return [rounded(column, 1 if index < 2 else 3) for index, column in enumerate((table.u_px, table.v_px, *residuals))]


def view_row(report, camera, view, corners):
    """What the table shows of one image."""
    used = corners["used"]
    T_cam_target = np.linalg.inv(camera.T_rig_cam) @ report.T_rig_target[view]
    centre = T_cam_target[:3, :3] @ report.board_m.mean(axis=0) + T_cam_target[:3, 3]
    tilt = np.degrees(np.arccos(np.clip(abs(T_cam_target[:3, 2] @ centre) / np.linalg.norm(centre), 0.0, 1.0)))
    rms = np.sqrt(np.mean(used.du_px ** 2 + used.dv_px ** 2)) if used.size else np.nan
    farthest = used.polar_deg.max(initial=0.0)
    return rounded([report.times_s[view]], 2) + [used.size, corners["rejected"].size, corners["missed"].size] + \
        rounded([rms, farthest, np.linalg.norm(centre), tilt], 3)


def camera_data(report, camera):
    pictures = {frame["view"]: frame for frame in camera.frames}
    kinds = {kind: getattr(camera, kind) for kind in ("used", "rejected", "missed")}
    by_view = {kind: table.by_view() for kind, table in kinds.items()}
    frames = {}
    for view in sorted(set().union(*by_view.values())):
        corners = {kind: by_view[kind].get(view, table.where(np.array([], dtype=int))) for kind, table in kinds.items()}
        frame = {"row": view_row(report, camera, view, corners)}
        frame.update({kind: corners_of(table) for kind, table in corners.items()})
        if view in pictures:
            frame["picture"] = data_url(report.picture(pictures[view]["file"]).read_bytes(), "jpeg")
        frames[view] = frame
    return {"name": camera.name, "width": camera.width, "height": camera.height, "frames": frames}


def write(report):
    data = json.dumps([camera_data(report, camera) for camera in report.cameras], separators=(",", ":"))
    page = TEMPLATE.read_text()
    for key, value in (("TITLE", html.escape(f"Calibration of {report.name}")), ("VERDICT", verdict_html(report)),
                       ("SUMMARY", summary_html(report)), ("RESULTS", html.escape(report.results_text)),
                       ("PAGES", pages_html(report)), ("DATA", data.replace("</", "<\\/"))):
        page = page.replace(f"<!--{key}-->", value)
    (report.folder / "report.html").write_text(page)
