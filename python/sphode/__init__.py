"""sphode: smoothed particle hydrodynamics as ODEs, from Python.

The installed C library, called through cffi; the reference of every function and member is its
headers.  docs/python.md tells how they look from here:

    import sphode
    sim = sphode.Simulation(dim=2, dx=0.01)
    water = sim.box("water", (0, 0), (1, 0.5), rho0=1000)
    water.eos = sphode.eos.tait(1000, 30, 7)
    sim.add(sphode.term.continuity(), sphode.term.pressure())
    sim.run(0.1)
    x, y = water["position"]
"""
from ._convert import struct
from ._library import Error, declarations_path, ffi, lib, library_path, version
from .callbacks import body
from .case import Case
from .definitions import boundary, eos, material, output, term
from .field import Ended, Field
from .results import Run, Snapshot
from .simulation import Group, Simulation

__version__ = version
__all__ = [
    "Case", "Ended", "Error", "Field", "Group", "Run", "Simulation", "Snapshot", "body", "boundary",
    "declarations_path", "eos", "ffi", "lib", "library_path", "material", "output", "struct",
    "term", "version",
]
