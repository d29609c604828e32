"""Snapshots in yt (https://yt-project.org): units, box and names are those of sphode.

    import sphode.yt
    ds = sphode.yt.load("run/snapshot_0010.hdf")
    ds.all_data()["water", "pressure"].to("kPa")

Not part of `import sphode`; wants yt 4 (Debian: python3-yt) and h5py.
"""
import numpy

from .results import _NAMES, _h5py

_OURS = {theirs: ours for ours, theirs in _NAMES.items()}


def _box(file):
    """Low and high corner [m]: the box of a run in periodic directions, else all particles and a
    spacing around them."""
    x = numpy.concatenate([file[part]["Coordinates"][()] for part in _parts(file)])
    around = file["Header"].attrs.get("Spacing", 0) or numpy.ptp(x) / 100 or 1
    low, high = x.min(axis=0) - around, x.max(axis=0) + around
    run = file["Parameters"].attrs if "Parameters" in file else {}
    periodic = numpy.array(run.get("Periodic", [0, 0, 0])) != 0
    if periodic.any():
        low = numpy.where(periodic, run["BoxOrigin"], low)
        high = numpy.where(periodic, low + run["BoxLength"], high)
    return low, high, periodic


def _parts(file):
    return [part for part in ("PartType0", "PartType1") if part in file and len(file[part]["Coordinates"])]


def _columns(file, part):
    """(name here, dataset, column or None, unit) of each field of a kind of particles."""
    dim = int(file["Header"].attrs["Dimension"])
    for name, data in file[part].items():
        if name in ("Coordinates", "Group", "ParticleIDs"):
            continue
        unit = data.attrs.get("unit", b"")
        unit = (unit.decode() if isinstance(unit, bytes) else unit).replace("^", "**").replace(" ", "*")
        ours = _OURS.get(name, name)
        if ours == "mass":  # yt computes with it
            unit = "kg"
        if data.ndim == 1:
            yield ours, name, None, unit
        else:
            for d in range(dim):
                yield f"{ours}_{'xyz'[d]}", name, d, unit


def _add_fields(ds, file, part):
    def values(dataset, column, unit):
        def read(field, data):  # names that yt asks for
            found = data[part, dataset].d
            return ds.arr(found if column is None else found[:, column], unit)
        return read

    for ours, dataset, column, unit in _columns(file, part):
        try:
            ds.quan(1, unit)
        except Exception:  # a unit that yt does not know: its numbers alone
            unit = ""
        ds.add_field((part, ours), values(dataset, column, unit), sampling_type="particle", units=unit,
                     take_log=False, force_override=True)


def _add_groups(ds, yt, groups):
    def chosen(index):
        return lambda filtered, data: data[filtered.filtered_type, "Group"].d == index

    for name, group in groups.items():
        part = f"PartType{int(group['PartType'])}"
        if group["NumPart"]:
            ds.add_particle_filter(yt.ParticleFilter(name, chosen(group["Index"]), ["Group"], part))


def load(path, **more):
    """A yt data set of a snapshot, or of what `sphode export --format gadget` made of one.

    Lengths, masses, velocities are in m, kg, m/s; in 2D a simulation is a metre deep, in 1D a square
    metre across.  The box is that of the run where it is periodic, elsewhere all particles and a
    spacing around them, and not periodic.

    Besides yt's own fields ("PartType0", "Velocities"; PartType0 fluids, PartType1 walls) there are
    those of sphode with their units, "pressure", "density", "velocity_x", "sound_speed", ..., for
    both, and for each group by its name: ds.all_data()["water", "pressure"].

    path: of a file; more: to yt.load.  ValueError: it is no snapshot of sphode.
    """
    import yt
    import yt.data_objects.particle_filters as filters

    with _h5py().File(str(path), "r") as file:
        if "Header" not in file or "Dimension" not in file["Header"].attrs or not _parts(file):
            raise ValueError(f"{path}: not a snapshot of sphode, or one without particles")
        low, high, periodic = _box(file)
        groups = {name: dict(group.attrs) for name, group in file.get("Groups", {}).items()}
        given = {"unit_base": {"length": (1, "m"), "mass": (1, "kg"), "velocity": (1, "m/s")},
                 "bounding_box": list(zip(low.tolist(), high.tolist())), **more}
        ds = yt.load(str(path), **given)
        ds._periodicity = tuple(bool(p) for p in periodic)  # the setter takes all or none
        for part in _parts(file):
            _add_fields(ds, file, part)
    _add_groups(ds, filters, groups)
    return ds
