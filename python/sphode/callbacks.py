"""Python functions where the library wants C ones.

An exception in one is kept, the run stops there, and the call of the library that led to it
(sim.run, ...) raises it again, itself, with its traceback.
"""
from ._convert import keep, struct
from ._library import ffi, lib, text_of
from .field import Field, Moment


class Caught:
    """What callbacks of one simulation have raised; the first counts."""

    def __init__(self):
        self.exception = None

    def guarded(self, signature, function, failed):
        """A C function of that signature; `failed` is what it returns where function raises."""
        def call(*arguments):
            try:
                return function(*arguments)
            except BaseException as raised:  # KeyboardInterrupt, too: the run stops
                self.exception = self.exception or raised
                return failed
        return ffi.callback(signature, call)

    def again(self):
        raised, self.exception = self.exception, None
        if raised is not None:
            raise raised


class Particles:
    """All particles of one fluid group, as sph_particles of sphode/term.h: views for this call.

    dim, n, t [s], group (its name); x[d], v[d], rho, u, p, c, m, s are read; a[d], drho, du, ds are
    added to.  What the group does not have is None.
    """

    def __init__(self, pointer, moment):
        self.dim, self.n, self.t = pointer.dim, pointer.n, pointer.t
        self.group = text_of(pointer.group)
        self._pointer, self._moment = pointer, moment

    def _view(self, name, pointer, written=None):
        if pointer == ffi.NULL:
            return None
        pointer = ffi.cast("double *", pointer)
        return Field(f"{name} of {self.group}", pointer, self.n, self._moment, written)

    def __getattr__(self, name):
        if name in ("x", "v", "a"):
            arrays = getattr(self._pointer, name)
            written = _anything if name == "a" else None
            value = [self._view(name, arrays[d], written) for d in range(self.dim)]
        elif name in ("rho", "u", "p", "c", "m", "s"):
            value = self._view(name, getattr(self._pointer, name))
        elif name in ("drho", "du", "ds"):
            value = self._view(name, getattr(self._pointer, name), _anything)
        else:
            raise AttributeError(f"particles have no '{name}'; they have dim, n, t, group, x, v, rho, u, "
                                 "p, c, m, s, a, drho, du, ds")
        setattr(self, name, value)
        return value


def _anything():
    """Rates may always be added to."""


def body(function, name=None, reads="", **members):
    """A term of your own: function(particles) adds to particles.a[d], drho, du [per second].

    It is called for each fluid group in each evaluation of the right-hand side.  reads: "pressure",
    "sound_speed", ... where it looks at what is not integrated.  members: others of sph_term, as
    scalar={"name": "dye", "scale": 1.0}.  An exception stops the run and comes out of sim.run.
    """
    caught = Caught()

    def evaluate(term, pointer):
        moment = Moment()
        try:
            function(Particles(pointer, moment))
        finally:
            moment.end("its callback has returned")
        return lib.SPH_OK

    callback = caught.guarded("int(const sph_term *, const sph_particles *)", evaluate,
                              lib.SPH_ERR_STOPPED)
    term = struct("sph_term", name=name or getattr(function, "__name__", "body").strip("<>"),
                  body=callback, reads=reads, **members)
    return keep(term, callback, caught)


def caught_of(cdata):
    """The Caught behind a definition that `body` made; None of others."""
    from ._convert import _kept
    return next((k for k in _kept.get(cdata, ()) if isinstance(k, Caught)), None)
