"""Simulations and their groups of particles."""
import weakref
from collections import namedtuple

import numpy

from ._convert import call, numbers, struct
from ._library import Error, ffi, lib, text_of
from .callbacks import Caught, caught_of
from .field import Field, Moment

Balance = namedtuple("Balance", "mass momentum angular_momentum kinetic internal potential total")


class Simulation:
    """A simulation: sph_sim of sphode/sim.h.

    Keywords are the members of sph_sim_def: dim, dx (needed), kernel, h_over_dx, threads, periodic,
    origin, length, speed, skin, search, isa, precision.  The first failure raises Error at once, and every use
    after it raises it again: right is a new one.
    """

    def __init__(self, **definition):
        self._setup(lib.sph_sim_create(struct("sph_sim_def", **definition)))
        self._checked()

    def _setup(self, pointer):
        if pointer == ffi.NULL:
            raise Error("out of memory", lib.SPH_ERR_MEMORY)
        self.pointer = ffi.gc(pointer, lib.sph_sim_free)
        self._held, self._caught, self._moment = [], [], Moment()
        self._written, self._progress, self._own = False, None, Caught()
        self._failed = False
        self._caught.append(self._own)
        after_step = weakref.WeakMethod(self._after_step)  # no cycle: freed once nobody refers to it
        callback = self._own.guarded("int(void *, sph_sim *)", lambda *_: after_step()(), 1)
        self._held.append(callback)
        lib.sph_sim_set_progress(self.pointer, callback, ffi.NULL)

    @classmethod
    def _of(cls, pointer):
        sim = cls.__new__(cls)
        sim._setup(pointer)
        sim._checked()
        return sim

    def _checked(self, status=0):
        """Raises what a callback raised, or the first failure of the simulation."""
        for caught in self._caught:
            caught.again()
        own = lib.sph_sim_status(self.pointer)
        status = own or status
        if status < 0:
            text = text_of(lib.sph_sim_error(self.pointer))
            if self._failed:
                text = f"this simulation failed before, and does nothing more; make a new one: {text}"
            self._failed = own < 0
            raise Error(text, status)

    def _moved(self, why):
        self._moment.end(why)
        self._moment = Moment()

    def _after_step(self):
        """Also where signals of Python are looked at: Ctrl-C stops the run."""
        if self._progress is None:
            return 0
        self._moved("the simulation went on")
        return 1 if self._progress(self) else 0

    def _forward(self, function, *values):
        if self._written:
            lib.sph_sim_changed(self.pointer)
            self._written = False
        self._moved("the simulation went on")
        try:
            status = function(self.pointer, *values)
        finally:
            self._moved("the simulation went on")
        self._checked(status)

    # ---- what it is made of

    def group(self, name, kind=None):
        """The group of that name; with a kind ("fluid", "wall") an empty new one."""
        pointer = lib.sph_sim_group(self.pointer, name.encode())
        if kind is not None:
            pointer = lib.sph_group_create(self.pointer, name.encode(), kind.encode())
            self._checked()
        elif pointer == ffi.NULL:
            known = ", ".join(group.name for group in self.groups) or "none"
            raise KeyError(f"no group '{name}'; there are {known}")
        return Group(self, pointer)

    @property
    def groups(self):
        found, k = [], 0
        while (pointer := lib.sph_sim_group_get(self.pointer, k)) != ffi.NULL:
            found.append(Group(self, pointer))
            k += 1
        return found

    def box(self, name, lo, hi, rho0):
        """A fluid that fills the box [lo, hi] [m] with density rho0 [kg/m^3]."""
        return self._made(lib.sph_group_box, name, lo, hi, rho0)

    def walls(self, name, lo, hi, rho0):
        """Walls around the box [lo, hi], as thick as the support."""
        return self._made(lib.sph_group_walls, name, lo, hi, rho0)

    def _made(self, function, name, lo, hi, rho0):
        for corner in (lo, hi):
            if len(corner) < self.dim:
                raise ValueError(f"{name}: a corner of {len(corner)} numbers in {self.dim} dimensions")
        pointer = call(function, self.pointer, name, lo, hi, rho0)
        self._moved("particles were added")
        self._checked()
        return Group(self, pointer)

    def add(self, *things):
        """Terms (sphode.term.*, sphode.body) and outputs (sphode.output.*)."""
        for thing in things:
            if not isinstance(thing, ffi.CData):
                raise TypeError(f"{thing!r}: wanted a term (sphode.term.*, sphode.body) or an output "
                                "(sphode.output.*)")
            value = thing[0] if ffi.typeof(thing).kind == "pointer" else thing
            kind = ffi.typeof(value).cname
            if kind not in ("sph_term", "sph_output"):
                raise TypeError(f"{kind}: wanted a term or an output")
            caught = caught_of(thing)
            if caught is not None and caught not in self._caught:
                self._caught.append(caught)
            self._held.append(thing)
            add = lib.sph_sim_add_term if kind == "sph_term" else lib.sph_sim_add_output
            add(self.pointer, value)
            self._checked()

    def integrator(self, method=None, **members):
        """The time integrator: members of sph_integrator_def, as cfl, tolerance, dt_fixed."""
        definition = struct("sph_integrator_def", method=method, **members)
        lib.sph_sim_set_integrator(self.pointer, definition)
        self._checked()

    def call(self, name, *values):
        """sph_sim_NAME(this simulation, values...), for what has no method here."""
        values = [v.pointer if isinstance(v, Group) else v for v in values]
        result = call(getattr(lib, "sph_sim_" + name), self.pointer, *values)
        self._held.extend(v for v in values if isinstance(v, ffi.CData))
        self._checked()
        return result

    # ---- going on

    def run(self, t_end, progress=None):
        """Runs to t_end [s], writing outputs; progress(sim) after each step: a true value stops."""
        self._progress = progress
        try:
            self._forward(lib.sph_sim_run, t_end)
        finally:
            self._progress = None

    def step(self, n=1):
        """n steps."""
        for _ in range(n):
            self._forward(lib.sph_sim_step)

    def evaluate(self):
        """The right-hand side of this state: pressure, walls, rates."""
        self._forward(lib.sph_sim_evaluate)

    def close(self):
        """Ends the simulation: outputs are closed, views end.  Later use raises Error."""
        self._moved("the simulation was closed")
        pointer, self.pointer = self.pointer, ffi.NULL
        if pointer != ffi.NULL:
            ffi.release(pointer)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    # ---- what it says

    time = property(lambda self: lib.sph_sim_time(self.pointer), doc="[s]")
    dim = property(lambda self: lib.sph_sim_dim(self.pointer))
    dx = property(lambda self: lib.sph_sim_dx(self.pointer), doc="[m]")
    h = property(lambda self: lib.sph_sim_h(self.pointer), doc="[m]")
    revision = property(lambda self: lib.sph_sim_revision(self.pointer))

    @property
    def balance(self):
        """Mass, momentum and energies of the fluids."""
        b = ffi.new("sph_balance *")
        lib.sph_sim_balance(self.pointer, b)
        return Balance(b.mass, tuple(b.momentum), tuple(b.angular_momentum), b.kinetic, b.internal,
                       b.potential, b.total)

    @property
    def stats(self):
        """sph_sim_stats: .step.steps, .step.rhs_evaluations, .seconds, ..."""
        stats = ffi.new("sph_sim_stats *")
        lib.sph_sim_get_stats(self.pointer, stats)
        return stats

    @property
    def warnings(self):
        """Lines about what will do nothing, is missing or will be slow."""
        found, text = [], ffi.new("char[2000]")
        while lib.sph_sim_warning(self.pointer, len(found), text, 2000):
            found.append(ffi.string(text).decode())
        return found


class Group:
    """A group of particles: sph_group of sphode/group.h.  group["velocity"] are its fields."""

    def __init__(self, sim, pointer):
        self.sim, self._pointer = sim, pointer

    @property
    def pointer(self):
        if self.sim.pointer == ffi.NULL:
            raise Error("the simulation was closed", lib.SPH_ERR_STATE)
        return self._pointer

    name = property(lambda self: text_of(lib.sph_group_name(self.pointer)))
    kind = property(lambda self: text_of(lib.sph_group_kind(self.pointer)))

    def __len__(self):
        return lib.sph_group_count(self.pointer)

    def __repr__(self):
        return f"<{self.kind} {self.name}, {len(self)} particles>"

    @property
    def fields(self):
        """{name: unit} of what can be read."""
        found, k = {}, 0
        while (info := lib.sph_group_field(self.pointer, k)) != ffi.NULL:
            if lib.sph_group_read(self.pointer, info.name, 0) != ffi.NULL:
                mass = ("kg/m^2", "kg/m", "kg")[self.sim.dim - 1]
                found[text_of(info.name)] = mass if text_of(info.name) == "mass" else text_of(info.unit)
            k += 1
        return found

    def _info(self, field):
        k = 0
        while (info := lib.sph_group_field(self.pointer, k)) != ffi.NULL:
            if text_of(info.name) == field:
                return info
            k += 1
        raise KeyError(f"group {self.name} has no field '{field}'; it has {', '.join(self.fields)}")

    def __getitem__(self, field):
        """Views, no copies: one of a scalar, a tuple with one per direction of a vector."""
        components = self.sim.dim if self._info(field).vector else 1
        views = tuple(self._view(field, d) for d in range(components))
        return views if self._info(field).vector else views[0]

    def _view(self, field, component):
        read = lib.sph_group_read(self.pointer, field.encode(), component)
        if read == ffi.NULL:
            self.sim._checked()
            raise KeyError(f"group {self.name} has no field '{field}'; it has {', '.join(self.fields)}")
        write = lib.sph_group_write(self.pointer, field.encode(), component)
        name = f"{self.name}.{field}" + (f"[{component}]" if self._info(field).vector else "")
        written = self._was_written if write == read else None
        return Field(name, ffi.cast("double *", read), len(self), self.sim._moment, written)

    def _was_written(self):
        self.sim._written = True

    def rate(self, field, component=0):
        """d(field)/dt of the last sim.evaluate()."""
        rate = lib.sph_group_rate(self.pointer, field.encode(), component)
        if rate == ffi.NULL:
            raise KeyError(f"group {self.name} integrates no '{field}'[{component}], or was not evaluated")
        return Field(f"d({self.name}.{field})/dt", ffi.cast("double *", rate), len(self),
                     self.sim._moment)

    @property
    def ids(self):
        ids = lib.sph_group_ids(self.pointer)
        self.sim._checked()
        return Field(f"{self.name}.ids", ffi.cast("long *", ids), len(self), self.sim._moment)

    def array(self, field):
        """A copy that lasts: [n] of a scalar, [n, dim] of a vector."""
        value = self[field]
        return numpy.stack(value, axis=1) if isinstance(value, tuple) else numpy.array(value)

    # ---- what it is made of

    def call(self, name, *values):
        """sph_group_NAME(this group, values...): add_box, add_ball, set_viscosity, ..."""
        result = call(getattr(lib, "sph_group_" + name), self.pointer, *values)
        self.sim._held.extend(v for v in values if isinstance(v, ffi.CData))
        self.sim._moved("the group was changed")
        self.sim._checked()
        return result

    def add_points(self, points, rho0):
        """Particles at points[n][dim] [m], each of mass rho0 dx^dim."""
        columns = [numbers(column) for column in numpy.asarray(points, dtype=float).T]
        if len(columns) != self.sim.dim:
            raise ValueError(f"points have {len(columns)} coordinates in {self.sim.dim} dimensions")
        x = ffi.new("const double *[]", [pointer for pointer, _ in columns])
        self.call("add_points", len(columns[0][1]), x, rho0)

    eos = property(lambda self: lib.sph_group_eos(self.pointer),
                   lambda self, value: self.call("set_eos", _value(value)))
    viscosity = property(lambda self: lib.sph_group_viscosity(self.pointer),
                         lambda self, value: self.call("set_viscosity", value))

    def set_boundary(self, value):
        """The model of a wall, sphode.boundary.*."""
        self.call("set_boundary", _value(value))

    boundary = property(None, set_boundary)


def _value(definition):
    return definition[0] if ffi.typeof(definition).kind == "pointer" else definition
