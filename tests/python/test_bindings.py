"""The Python package against the C library: prints TAP.  test_bindings.py BUILDDIR SRCDIR, in an empty directory."""
import gc
import math
import os
import signal
import subprocess
import sys
import traceback

import numpy as np

import sphode
from sphode import ffi, lib, term

BUILD, SOURCE = sys.argv[1:3]
tests = []


def test(function):
    tests.append(function)


def raised(kind, function, *arguments, **options):
    """The exception of that kind that function raises."""
    try:
        function(*arguments, **options)
    except kind as exception:
        return exception
    raise AssertionError(f"no {kind.__name__}")


def column(*more, walls=True):
    sim = sphode.Simulation(dim=2, dx=0.05)
    water = sim.box("water", (0, 0), (0.5, 0.5), 1000)
    water.eos = sphode.eos.tait(1000, 30, 7)
    if walls:
        tank = sim.walls("tank", (0, 0), (1, 1), 1000)
        tank.boundary = sphode.boundary.adami()
    sim.add(term.continuity(), term.pressure(), term.viscosity_artificial(0.02, 0), *more)
    return sim, water


@test
def layout_is_that_of_the_compiler():
    functions = ("sph_motion", "sph_rotation", "sph_surface")
    names = [name for name in ffi.list_types()[0] if name not in functions]
    structs = [s for s in map(ffi.typeof, names) if s.kind == "struct" and s.fields is not None]
    assert len(structs) > 40
    lines, ours = [], []
    for s in structs:
        lines.append(f'printf("%s %zu\\n", "{s.cname}", sizeof({s.cname}));')
        ours.append(f"{s.cname} {ffi.sizeof(s)}")
        for member, field in s.fields:
            if field.bitsize < 0:
                lines.append(f'printf("%s.%s %zu\\n", "{s.cname}", "{member}", offsetof({s.cname}, {member}));')
                ours.append(f"{s.cname}.{member} {field.offset}")
    with open("layout.c", "w") as file:
        file.write("#include <sphode.h>\n#include <stddef.h>\n#include <stdio.h>\nint main(void) {"
                   + "\n".join(lines) + "return 0; }\n")
    subprocess.run(os.environ.get("CC", "cc").split()
                   + ["-I", SOURCE + "/include", "layout.c", "-o", "layout"], check=True)
    theirs = subprocess.run(["./layout"], check=True, capture_output=True, text=True).stdout.split("\n")
    assert theirs[:-1] == ours, set(theirs) ^ set(ours)


@test
def every_function_is_in_the_library():
    with open(sphode.declarations_path) as file:
        declared = {word.split("(")[0].lstrip("*") for line in file for word in line.split()
                    if word.lstrip("*").startswith("sph_") and "(" in word}
    functions = [name for name in dir(lib) if name.startswith("sph_")]
    for name in functions:
        getattr(lib, name)
    assert len(functions) > 200 and len(set(functions) - declared) < 10


@test
def a_case_has_the_bits_of_the_program():
    path, settings = SOURCE + "/cases/sod-1d.yml", {"spacing": "0.01", "run.end": "0.02"}
    subprocess.run([BUILD + "/sphode", "run", "-q", "-o", "program", path]
                   + [f"--set={key}={value}" for key, value in settings.items()], check=True)
    case = sphode.Case(path, settings)
    sim = case.simulation("python")
    sim.run(case.end)
    last = {field: sim.group("gas").array(field) for field in ("position", "velocity", "density")}
    comparisons = case.compare(sim, "python")
    sim.close()
    assert len(comparisons) > 1 and all(c.value > 0 for c in comparisons)
    a, b = sphode.Run("program"), sphode.Run("python")
    assert len(a) == len(b) >= 2 and a.times[-1] == 0.02
    for k in range(len(a)):
        for field, values in a[k]["gas"].items():
            assert (values == b[k]["gas"][field]).all(), field
    found = a[-1]["gas"]
    assert (found["velocity"] == last["velocity"]).all() and (found["density"] == last["density"]).all()
    table = a.table()
    assert table["time"][-1] == 0.02 and a.units()["time"] == "s" and a.units()["step"] == "1"


@test
def results_are_sequences_and_mappings():
    run = sphode.Run("program")
    last = run[-1]
    assert list(last) == ["gas"] and len(last) == 1 and "gas" in last and 0 not in last and "air" not in last
    assert [name for name, gas in last.items()] == ["gas"] and "gas" in repr(last)
    assert [s.time for s in run] == list(run.times) and [s.time for s in run[-2:]] == list(run.times[-2:])
    raised(IndexError, run.__getitem__, len(run))
    for there, what, missing in ((last, "gas", "air"), (last["gas"], "velocity", "temperature"),
                                 (run.table(), "kinetic", "front"), (run.units(), "kinetic", "front")):
        said = str(raised(KeyError, there.__getitem__, missing))
        assert what in there and missing not in there and there.get(missing) is None
        assert f"no group '{missing}'" in said or f"no '{missing}'" in said, said
        assert what in said and "program" in said, said


@test
def views_are_the_memory_of_the_library():
    sim, water = column()
    x, y = water["position"]
    pointer = lib.sph_group_read(water.pointer, b"position", 1)
    assert y.raw.ctypes.data == int(ffi.cast("intptr_t", pointer))
    y[3] = 0.123
    assert pointer[3] == 0.123
    y += 1.0
    y *= np.full(len(y), 2.0)
    assert pointer[3] == 2 * (0.123 + 1.0)
    np.add(y, 1, out=y)
    assert pointer[3] == 2 * (0.123 + 1.0) + 1
    assert type(x + y) is np.ndarray and x.sum() == np.sum(x)
    assert math.isclose(sum(x), x.sum()) and math.isclose(np.dot(x, y), (x * y).sum())
    assert not np.shares_memory(np.asarray(x), x.raw) and not np.shares_memory(x[2:4], x.raw)
    assert (np.concatenate([x, y]) == np.append(x.raw, y.raw)).all()
    assert len(x) == len(water) == 100


@test
def views_end_when_the_simulation_goes_on():
    sim, water = column()
    going_on = [lambda: sim.step(), lambda: sim.run(sim.time + 0.01), sim.evaluate, sim.close]
    for go in going_on:
        x, lasting = water["position"][0], water.array("position")
        go()
        for use in (lambda: x[0], lambda: x + 1, lambda: np.sin(x), lambda: np.sum(x), lambda: x.raw,
                    lambda: x.__setitem__(0, 1.0), lambda: np.array(x), lambda: len(x), lambda: list(x),
                    lambda: x.max()):
            assert "position[0]" in str(raised(sphode.Ended, use))
        assert lasting.shape == (100, 2) and np.isfinite(lasting).all()
    raised(sphode.Error, len, water)
    sim, water = column()
    x = water["position"][0]
    water.call("add_box", (0.55, 0.05), (0.6, 0.1), 1000.0)
    raised(sphode.Ended, lambda: x[0])


@test
def what_is_written_between_steps_is_not_lost():
    ends = []
    for say in (True, False):
        sim, water = column(term.gravity((0, -9.81)))
        sim.step(3)
        u, v = water["velocity"]
        u += 0.1
        if say:
            sim.call("changed")
        sim.step(3)
        ends.append(water.array("velocity"))
    assert (ends[0] == ends[1]).all() and abs(ends[0][:, 0].mean() - 0.1) < 0.05
    rate = water.rate("velocity", 0) if sim.evaluate() is None else None
    assert isinstance(raised(ValueError, rate.__setitem__, 0, 1.0), ValueError)


@test
def a_body_force_in_python_is_gravity():
    seen = set()

    def down(p):
        seen.add((p.group, p.n, p.dim))
        p.a[1] -= 9.81
        assert p.u is None and p.ds is None and len(p.x) == 2 and (p.rho > 900).all()

    a, water = column(term.gravity((0, -9.81)), walls=False)  # walls know of a uniform force
    b, other = column(sphode.body(down), walls=False)
    for sim, group in ((a, water), (b, other)):
        group["velocity"][0][:] = group["position"][1]
        sim.integrator("leapfrog", dt_fixed=2e-4)
        sim.run(0.05)
    assert seen == {("water", 100, 2)}
    v, w = water.array("velocity"), other.array("velocity")
    assert abs(v - w).max() < 1e-12 and abs(v[:, 1].mean() + 9.81 * 0.05) < 1e-12 and v[:, 0].std() > 0.1


@test
def an_exception_comes_out_and_nothing_is_lost():
    class Mine(Exception):
        pass

    kept = []

    def failing(p):
        kept.append(p.x[0])
        if p.t > 0.02:
            raise Mine("at t = %g" % p.t)

    sim, water = column(sphode.body(failing), sphode.output.series("failed", 0.005, None, 0))
    exception = raised(Mine, sim.run, 1.0)
    assert "failing" in [frame.name for frame in traceback.extract_tb(exception.__traceback__)]
    assert 0.015 < sim.time <= 0.0201 and np.isfinite(water.array("velocity")).all()
    after = raised(sphode.Error, sim.step)
    assert after.status == lib.SPH_ERR_STOPPED and after.name == "SPH_ERR_STOPPED" and "failing" in str(after)
    raised(sphode.Ended, lambda: kept[0][0])
    with open("failed/series.csv") as file:
        assert len(file.readlines()) >= 4


@test
def ctrl_c_stops_a_run():
    def interrupted(p):
        if p.t > 0.01:
            signal.raise_signal(signal.SIGINT)

    sim, _ = column(sphode.body(interrupted))
    signal.signal(signal.SIGINT, signal.default_int_handler)  # ignored where a shell started us in the background
    raised(KeyboardInterrupt, sim.run, 1.0)
    sim, _ = column()
    stop = raised(sphode.Error, sim.run, 1.0, progress=lambda s: s.time > 0.01)
    assert stop.name == "SPH_ERR_STOPPED" and 0.01 < sim.time < 0.03


@test
def mistakes_are_told():
    assert "dim = 4" in str(raised(sphode.Error, sphode.Simulation, dim=4, dx=1))
    assert "h_over_dx" in str(raised(TypeError, sphode.Simulation, dim=2, dx=1, h_by_dx=2))
    sim, water = column()
    assert "velocity" in str(raised(KeyError, lambda: water["velocty"]))
    assert "tank" in str(raised(KeyError, sim.group, "tnak"))
    assert "ideal_gas" in str(raised(AttributeError, lambda: sphode.eos.ideal))
    raised(ValueError, sim.box, "more", (0,), (1, 1), 1000)
    raised(TypeError, term.gravity, 1, 2)
    assert "gamma" in str(raised(TypeError, sphode.eos.tait, 1000, 30, "a")) and "c0" in str(
        raised(TypeError, sphode.eos.tait, 1000, "a", 7))
    assert "3: wanted a term" in str(raised(TypeError, sim.add, 3))
    assert "rk4" in str(raised(sphode.Error, sim.integrator, "rk4"))
    assert "failed before" in str(raised(sphode.Error, sim.integrator, "leapfrog"))
    sim, water = column()
    with open("bad.yml", "w") as file:
        file.write("dimension: 2\nspacing: 1 s\n")
    error = raised(sphode.Error, sphode.Case, "bad.yml")
    assert str(error).startswith("bad.yml:2:10: ") and error.name == "SPH_ERR_PARSE"
    assert "'spacng'" in str(raised(sphode.Error, sphode.Case, SOURCE + "/cases/sod-1d.yml", {"spacng": 1}))


@test
def nothing_is_freed_too_early():
    for k in range(30):
        sim, water = column(sphode.body(lambda p: None, name=f"own{k}", reads=""))
        sim.add(sphode.output.series_def({"directory": "early", "interval": 0.01, "monitors": 1,
                                          "monitor": [{"name": f"front{k}", "type": "front"}]}))
        gc.collect()
        sim.step()
        eos = sphode.eos.tait_matched(water.eos, 800.0, 7.0)
        gc.collect()
        assert ffi.string(eos.name) == b"tait" and math.isclose(eos.rho0 * eos.c0 ** 2, 1000 * 30 ** 2)
    points = np.random.default_rng(1).permutation(np.argwhere(np.ones((5, 5))) * 0.1)
    sim = sphode.Simulation(dim=2, dx=0.1)
    group = sim.group("dots", "fluid")
    group.add_points(points, 1.0)
    assert (group.array("position") == points).all()


class StandIn:
    """What sphode.yt asks of yt, as far as it can be told without it; tests/property/test_readers.sh has the real one."""

    def __init__(self, path, unit_base, bounding_box):
        self.path, self.unit_base, self.box, self.fields, self.filters = path, unit_base, bounding_box, {}, {}

    def quan(self, value, unit):
        if unit == "furlong":
            raise ValueError(unit)
        return value

    def arr(self, values, unit):
        return values, unit

    def add_field(self, name, function, sampling_type, units, take_log, force_override):
        assert sampling_type == "particle" and force_override and function.__code__.co_varnames[:2] == ("field", "data")
        self.fields[name] = function, units

    def add_particle_filter(self, made):
        self.filters[made[0]] = made[1:]


@test
def yt_is_told_units_box_and_names():
    import types
    import h5py
    import sphode.yt
    with open("two.yml", "w") as file:
        file.write("dimension: 2\nspacing: 0.1 m\nperiodic: {axes: [x], lower: [0, 0], upper: [1, 1]}\ngroups:\n"
                   + "".join(f"  {name}: {{kind: {kind}, density: {rho}, eos: {{linear: {{sound_speed: 20}}}}, shapes: [box: {{lower: [0, {y}], upper: [1, {y + 0.5}]}}]}}\n"
                             for name, kind, rho, y in (("oil", "fluid", 800, 0.5), ("water", "fluid", 1000, 0), ("floor", "wall", 1000, -0.5)))
                   + "terms: {continuity: {}, pressure: {}, gravity: {acceleration: [1, -9.81]}}\nrun: {end: 1 ms}\noutput: {snapshots: 1 ms}\n")
    subprocess.run([BUILD + "/sphode", "run", "-q", "-o", "two", "two.yml"], check=True)
    path = "two/snapshot_0001.hdf"
    with h5py.File(path, "a") as file:
        file["PartType0/Odd"] = np.arange(100.0)
        file["PartType0/Odd"].attrs["unit"] = "furlong"
    filters = types.ModuleType("yt.data_objects.particle_filters")
    filters.ParticleFilter = lambda *given: given
    objects = types.ModuleType("yt.data_objects")
    objects.particle_filters = filters
    yt = types.ModuleType("yt")
    yt.load, yt.data_objects = StandIn, objects
    fake = {"yt": yt, "yt.data_objects": objects, "yt.data_objects.particle_filters": filters}
    before = {name: sys.modules.pop(name, None) for name in fake}
    sys.modules.update(fake)
    try:
        ds = sphode.yt.load(path)
        other = raised(ValueError, sphode.yt.load, _empty())
        assert "not a snapshot of sphode" in str(other)
    finally:
        for name in fake:
            sys.modules.pop(name)
            if before[name]:
                sys.modules[name] = before[name]
    assert ds.path == path and ds.unit_base == {"length": (1, "m"), "mass": (1, "kg"), "velocity": (1, "m/s")}
    assert np.allclose(ds.box, [(0, 1), (-0.55, 1.05), (-0.1, 0.1)], atol=1e-3) and ds._periodicity == (True, False, False)
    units = {name: unit for (part, name), (_, unit) in ds.fields.items() if part == "PartType0"}
    right = {"velocity_x": "m/s", "velocity_y": "m/s", "pressure": "Pa", "density": "kg/m**3", "mass": "kg", "energy": "J/kg", "h": "m",
             "sound_speed": "m/s", "Odd": ""}
    assert units == right, units
    assert ("PartType1", "density") in ds.fields and set(ds.filters) == {"oil", "water", "floor"}

    class Numbers(dict):
        def __missing__(self, key):
            with h5py.File(path) as file:
                return types.SimpleNamespace(d=file["/".join(key)][()])

    numbers, snapshot = Numbers(), sphode.Snapshot(path)
    v, unit = ds.fields["PartType0", "velocity_y"][0](None, numbers)
    assert unit == "m/s" and v.shape == (100,) and v.mean() < -1e-3 and (v == numbers["PartType0", "Velocities"].d[:, 1]).all()
    for name in ("oil", "water"):
        chosen, needs, part = ds.filters[name]
        mine = chosen(types.SimpleNamespace(filtered_type=part), numbers)
        assert part == "PartType0" and needs == ["Group"] and (numbers[part, "Density"].d[mine] == snapshot[name]["density"]).all() and mine.sum() == 50


def _empty():
    import h5py
    with h5py.File("empty.hdf", "w") as file:
        file.create_group("Header")
    return "empty.hdf"


@test
def the_package_says_the_same_version():
    with open(SOURCE + "/python/pyproject.toml") as file:
        assert f'version = "{sphode.version}"' in file.read(), f"python/pyproject.toml is not of {sphode.version}"


@test
def another_version_is_refused():
    with open(sphode.declarations_path) as file:
        text = file.read()
    with open("other.h", "w") as file:
        file.write(text.replace(f'"{sphode.version}"', '"0.0.1"', 1))
    found = subprocess.run([sys.executable, "-c", "import sphode"], capture_output=True, text=True,
                           env=dict(os.environ, SPHODE_DECLARATIONS="other.h"), check=False)
    assert found.returncode != 0 and "0.0.1" in found.stderr


@test
def pkg_config_finds_it():
    os.makedirs("pc", exist_ok=True)
    with open("pc/sphode.pc", "w") as file:
        file.write(f"library={sphode.library_path}\ndeclarations={sphode.declarations_path}\n\n"
                   "Name: sphode\nDescription: .\nVersion: 1\n")
    environment = {k: v for k, v in os.environ.items() if not k.startswith("SPHODE_")}
    for path, right in (("pc", True), ("nowhere", False)):
        found = subprocess.run([sys.executable, "-c", "import sphode; print(sphode.version)"],
                               env=dict(environment, PKG_CONFIG_PATH=path, PKG_CONFIG_LIBDIR=path),
                               capture_output=True, text=True, check=False)
        assert (found.stdout.strip() == sphode.version) == right, found
    assert "pkg-config knows none" in found.stderr


@test
def the_example_is_right():
    done = subprocess.run([sys.executable, SOURCE + "/python/examples/sloshing.py", "16", "sloshing.png"],
                          capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "missing" in done.stdout or os.path.getsize("sloshing.png") > 20000


print(f"1..{len(tests)}")
for number, function in enumerate(tests, 1):
    name = function.__name__.replace("_", " ")
    try:
        function()
        print(f"ok {number} - {name}", flush=True)
    except BaseException:
        print(f"not ok {number} - {name}")
        print("# " + traceback.format_exc().replace("\n", "\n# "), flush=True)
