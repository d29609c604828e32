"""What a run has written: snapshots (by h5py) and tables."""
import collections.abc
import csv
import json
import os
import re

import numpy

# Where GADGET's names differ from those of the library.
_NAMES = {"position": "Coordinates", "velocity": "Velocities", "density": "Density", "mass": "Masses",
          "pressure": "Pressure", "energy": "InternalEnergy", "sound_speed": "SoundSpeed",
          "id": "ParticleIDs", "h": "SmoothingLength"}


class Table(dict):
    """A dict of arrays, whose KeyError names what there is."""

    def __init__(self, what, items):
        super().__init__(items)
        self._what = what

    def __missing__(self, name):
        raise KeyError(f"{self._what} has no '{name}'; it has {', '.join(self)}")


class Snapshot(collections.abc.Mapping):
    """A snapshot file as a mapping: snapshot["water"] is a dict of arrays of that group's particles,
    list(snapshot) names the groups."""

    def __init__(self, path):
        self.path = str(path)
        with _h5py().File(self.path, "r") as file:
            self.time = float(file["Header"].attrs["Time"])
            self.dim = int(file["Header"].attrs["Dimension"])
            self.groups = {name: dict(group.attrs) for name, group in file["Groups"].items()}

    def __getitem__(self, name):
        if name not in self.groups:
            raise KeyError(f"{self.path} has no group '{name}'; it has {', '.join(self.groups)}")
        group, ours = self.groups[name], {value: key for key, value in _NAMES.items()}
        with _h5py().File(self.path, "r") as file:
            part = file[f"PartType{int(group['PartType'])}"]
            mine = part["Group"][()] == group["Index"]
            fields = {ours.get(field, field): part[field][()][mine] for field in part
                      if field != "Group"}
        return Table(f"{name} of {self.path}", {field: value[:, :self.dim] if value.ndim == 2 else value
                                                for field, value in fields.items()})

    def __iter__(self):
        return iter(self.groups)

    def __len__(self):
        return len(self.groups)

    def __contains__(self, name):
        return name in self.groups

    def __eq__(self, other):
        return self is other

    __hash__ = object.__hash__

    def __repr__(self):
        return f"<snapshot {self.path}, t = {self.time:g} s: {', '.join(self)}>"


class Run(collections.abc.Sequence):
    """The directory of a run as a sequence of its snapshots: run[k] is number k, run.times are theirs,
    run.table() its series."""

    def __init__(self, directory):
        self.directory = str(directory)
        series = os.path.join(self.directory, "snapshot.hdf.series")
        with open(series, encoding="utf-8") as file:
            files = json.load(file)["files"]
        self.files = [entry["name"] for entry in files]
        self.times = numpy.array([entry["time"] for entry in files])

    def __len__(self):
        return len(self.files)

    def __getitem__(self, k):
        if isinstance(k, slice):
            return [self[i] for i in range(*k.indices(len(self)))]
        return Snapshot(os.path.join(self.directory, self.files[k]))

    def table(self, name="series.csv"):
        """{column: array} of a table of the run, names without their units (see units);
        columns of words are lists of str."""
        with open(os.path.join(self.directory, name), newline="", encoding="utf-8") as file:
            rows = [row for row in csv.reader(file) if row and not row[0].startswith("#")]
        names = [re.sub(r" \[.*\]$", "", column) for column in rows[0]]
        return Table(os.path.join(self.directory, name),
                     {column: _numbers([row[k] for row in rows[1:]]) for k, column in enumerate(names)})

    def units(self, name="series.csv"):
        """{column: unit}; "1" where a column has none."""
        with open(os.path.join(self.directory, name), newline="", encoding="utf-8") as file:
            head = next(row for row in csv.reader(file) if not row[0].startswith("#"))
        found = (re.fullmatch(r"(.*?)(?: \[(.*)\])?", column) for column in head)
        return Table(os.path.join(self.directory, name), {match[1]: match[2] or "1" for match in found})


def _numbers(words):
    try:
        return numpy.array(words, dtype=float)
    except ValueError:
        return words


def _h5py():
    try:
        import h5py
    except ImportError as missing:
        raise ImportError("snapshots are read by h5py (Debian: python3-h5py; pip install h5py)") from missing
    return h5py
