"""Views of the library's arrays: no copies, and no access once the arrays may have moved."""
import numbers

import numpy
from numpy.lib.mixins import NDArrayOperatorsMixin

from ._library import ffi


class Ended(RuntimeError):
    """A view was used after the simulation went on; take it again."""


class Moment:
    """As long as it lasts, views that were taken in it may be used."""

    def __init__(self):
        self.over = None  # why

    def end(self, why):
        self.over = self.over or why


class Field(NDArrayOperatorsMixin):
    """One component of a field, [count]: numpy's operators and functions work on the library's memory.

    It may be used until the simulation makes a step, sorts or moves its particles; after that every
    access raises Ended.  What is computed with it (`2 * x`, `x.max()`) is a numpy array of its own,
    and so is numpy.array(field): those last.  `raw` is the bare numpy array, for loops that cannot
    take a Field: it must not be kept, since nothing guards it.
    """

    __slots__ = ("name", "_array", "_moment", "_written")

    def __init__(self, name, pointer, count, moment, written=None):
        buffer = ffi.buffer(pointer, count * ffi.sizeof(ffi.typeof(pointer).item)) if count else b""
        kind = {"double": float, "long": numpy.dtype("l")}[ffi.typeof(pointer).item.cname]
        self.name = name
        self._array = numpy.frombuffer(buffer, dtype=kind)
        self._moment = moment
        self._written = written  # called before a write; None: it is read only
        if written is None:
            self._array.flags.writeable = False

    @property
    def raw(self):
        """The library's memory as a plain numpy array: use it at once, do not keep it."""
        if self._moment.over:
            raise Ended(f"the view of {self.name} ended: {self._moment.over}; take it again")
        return self._array

    def _to_write(self):
        array = self.raw
        if self._written is None:
            raise ValueError(f"{self.name} is read only")
        self._written()
        return array

    def __len__(self):
        return len(self.raw)

    def __getitem__(self, where):
        item = self.raw[where]
        return item.copy() if isinstance(item, numpy.ndarray) else item

    def __setitem__(self, where, value):
        self._to_write()[where] = _bare(value)

    def __iter__(self):
        return iter(self.raw.tolist())

    def __array__(self, dtype=None, copy=None):
        if copy is False:
            raise ValueError(f"{self.name}: numpy arrays of a view are copies; see Field.raw")
        return numpy.array(self.raw, dtype=dtype)

    def __array_ufunc__(self, ufunc, method, *inputs, out=None, **options):
        if out is not None:
            options["out"] = tuple(o._to_write() if isinstance(o, Field) else o for o in out)
        result = getattr(ufunc, method)(*(_bare(x) for x in inputs), **options)
        return out[0] if out is not None and len(out) == 1 else result

    def __array_function__(self, function, types, arguments, options):
        if "out" in options:
            options = dict(options, out=_bare_to_write(options["out"]))
        result = function(*_bare_deep(arguments), **{k: _bare_deep(v) for k, v in options.items()})
        ours = isinstance(result, numpy.ndarray) and numpy.may_share_memory(result, self._array)
        return result.copy() if ours else result

    def __repr__(self):
        if self._moment.over:
            return f"<view of {self.name}, ended: {self._moment.over}>"
        return f"<view of {self.name}: {self._array!r}>"

    dtype = property(lambda self: self.raw.dtype)
    shape = property(lambda self: self.raw.shape)
    size = property(lambda self: self.raw.size)
    ndim = property(lambda self: 1)

    def copy(self):
        """A numpy array of its own."""
        return self.raw.copy()

    def sum(self, **options):
        return self.raw.sum(**options)

    def mean(self, **options):
        return self.raw.mean(**options)

    def min(self, **options):
        return self.raw.min(**options)

    def max(self, **options):
        return self.raw.max(**options)


def _bare(value):
    return value.raw if isinstance(value, Field) else value


def _bare_to_write(value):
    return value._to_write() if isinstance(value, Field) else value


def _bare_deep(value):
    if isinstance(value, (tuple, list)):
        return type(value)(_bare_deep(v) for v in value)
    return value if isinstance(value, numbers.Number) else _bare(value)
