"""Case files."""
from collections import namedtuple

from ._convert import call
from ._library import Error, ffi, lib, text_of
from .simulation import Simulation

Comparison = namedtuple("Comparison", "name reference quantity norm value bar passed note")


class Case:
    """A case file that was read and checked: sph_case of sphode/case.h.

    set: {"spacing": "1 cm", "groups.water.density": 900}, in place of what the file says.  What is
    wrong raises Error with file, line and column.
    """

    def __init__(self, path, set=None):
        sets = [f"{key}={value}" for key, value in (set or {}).items()]
        error = ffi.new("sph_error *")
        pointer = call(lib.sph_case_read, str(path), len(sets), sets, error)
        self.pointer = ffi.gc(_good(pointer, error), lib.sph_case_free)

    title = property(lambda self: text_of(lib.sph_case_title(self.pointer)))
    text = property(lambda self: text_of(lib.sph_case_text(self.pointer)))
    end = property(lambda self: lib.sph_case_end(self.pointer), doc="[s]")

    def simulation(self, directory=None, threads=0):
        """The simulation of the case; with a directory, its outputs and checkpoints go there."""
        error = ffi.new("sph_error *")
        pointer = _good(lib.sph_case_build(self.pointer, threads, error), error)
        sim = Simulation._of(pointer)
        sim._held.append(self)
        if directory is not None:
            where = str(directory).encode()
            lib.sph_case_build_outputs(self.pointer, sim.pointer, where, ffi.NULL)
            lib.sph_case_build_checkpoints(self.pointer, sim.pointer, where, ffi.NULL)
            sim._checked()
        return sim

    def compare(self, sim, directory):
        """What a finished run says against the references of the case: a list of Comparison."""
        error, found, n = ffi.new("sph_error *"), ffi.new("sph_comparison **"), ffi.new("int *")
        status = lib.sph_case_compare(self.pointer, sim.pointer, str(directory).encode(), found, n,
                                      error)
        if status < 0:
            raise Error(text_of(error.text), error.status)
        try:
            return [Comparison(text_of(c.name), text_of(c.reference), text_of(c.quantity),
                               text_of(c.norm), c.value, c.bar, bool(c.value <= c.bar),
                               text_of(c.note)) for c in found[0][0:n[0]]]
        finally:
            lib.sph_case_compare_free(found[0], n[0])


def _good(pointer, error):
    if pointer == ffi.NULL:
        raise Error(text_of(error.text) or "out of memory", error.status)
    return pointer
