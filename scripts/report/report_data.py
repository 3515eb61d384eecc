"""Reads what calibrate_cameras leaves for the report: data.json and the tables of doubles that it names."""

import json
from pathlib import Path

import numpy as np


class Table:
    """Columns by name, as attributes."""

    def __init__(self, folder, description):
        values = np.fromfile(folder / description["file"]).reshape(-1, len(description["columns"]))
        for index, column in enumerate(description["columns"]):
            setattr(self, column, values[:, index])
        self.size = len(values)

    def by_view(self):
        """The rows of each view, as a table."""
        order = np.argsort(self.view, kind="stable")
        views, starts = np.unique(self.view[order], return_index=True)
        return {int(view): self.where(rows) for view, rows in zip(views, np.split(order, starts[1:]))}

    def where(self, mask):
        """The rows that a mask or a list of indices selects, as a table."""
        chosen = object.__new__(Table)
        for name, column in vars(self).items():
            if name != "size":
                setattr(chosen, name, column[mask])
        chosen.size = len(chosen.view)
        return chosen


class Camera:
    """One camera: what data.json says about it as attributes, its tables read."""

    def __init__(self, folder, description):
        vars(self).update(description)
        for name in ("found", "missed", "map", "curve"):
            setattr(self, name, Table(folder, description[name]))
        self.used = self.found.where(self.found.used > 0)
        self.rejected = self.found.where(self.found.used == 0)
        if self.frames:
            self.missed = self.missed.where(self.is_seen(self.missed.u_px, self.missed.v_px))
        self.max_polar_deg = self.statistics["max_polar_deg"]
        self.T_rig_cam = np.array(self.T_rig_cam)

    def is_seen(self, u_px, v_px):
        """Whether the pictures show anything at these pixels, by the nearest sample of the map."""
        u, v = self.grid("u_px")[0], self.grid("v_px")[:, 0]
        nearest = [np.abs(line[None] - np.asarray(px)[:, None]).argmin(axis=1) for line, px in ((u, u_px), (v, v_px))]
        return self.grid("seen")[nearest[1], nearest[0]] > 0

    def grid(self, column):
        """A column of the map as an image of rows and columns."""
        return getattr(self.map, column).reshape(self.map_rows, -1)


class Report:
    """All of a run."""

    def __init__(self, folder):
        self.folder = Path(folder)
        self.part_done = lambda: None  # called after every part of the pages
        description = json.loads((self.folder / "data.json").read_text())
        vars(self).update(description)
        self.name = Path(self.recording).stem or self.recording
        self.cameras = [Camera(self.folder, camera) for camera in description["cameras"]]
        self.T_rig_target = np.array([view["T_rig_target"] for view in self.views]).reshape(-1, 4, 4)
        self.stamps_ns = [view["stamp_ns"] for view in self.views]
        self.board_m = np.array(self.board_m)
        start_ns = min(self.stamps_ns, default=0)
        self.times_s = np.array([(stamp - start_ns) * 1e-9 for stamp in self.stamps_ns])

    def picture(self, name):
        return self.folder / name
