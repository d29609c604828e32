"""Python values as arguments of C: str, sequences, dicts, None."""
import re
import weakref

import numpy

from ._library import declarations_path, ffi, lib

# What a C value points to lives as long as the value does.
_kept = weakref.WeakKeyDictionary()


def keep(owner, *things):
    """Lets things live as long as owner, a cffi object."""
    _kept.setdefault(owner, []).extend(things)
    return owner


def numbers(values):
    """(double *, what it points into): of any sequence of numbers; without a copy where it can be.

    Fewer than three are followed by zeros: C may read a vector of three in any dimension.
    """
    array = numpy.ascontiguousarray(values, dtype=numpy.float64)
    if array.size < 3:
        array = numpy.append(array, numpy.zeros(3 - array.size))
    return ffi.cast("double *", array.ctypes.data), array


def _item_is_const_char(ctype):
    return ctype.kind == "pointer" and ctype.item.kind == "primitive" and ctype.item.cname == "char"


def to_c(value, ctype, held):
    """value as ctype; what it points to is appended to held, to be kept as long as it is used."""
    if isinstance(value, ffi.CData) or callable(value):
        held.append(value)
        return value
    if ctype.kind == "pointer":
        if value is None:
            return ffi.NULL
        if _item_is_const_char(ctype):
            made = ffi.new("char[]", value.encode())
        elif isinstance(value, dict):
            made = struct(ctype.item.cname, **value)
        elif ctype.item.kind == "struct":
            made = ffi.new(ctype.item.cname + "[]", [_struct_of(v, ctype.item, held) for v in value])
        elif ctype.item.kind == "pointer":
            made = ffi.new(ffi.getctype(ctype.item, "[]"),
                           [to_c(v, ctype.item, held) for v in value])
        elif ctype.item.cname == "double":
            made, array = numbers(value)
            held.append(array)
        else:
            return value
        held.append(made)
        return made
    if ctype.kind == "struct" and isinstance(value, dict):
        return _struct_of(value, ctype, held)
    if ctype.kind == "array" and not isinstance(value, str):
        items = [to_c(v, ctype.item, held) for v in value]
        if len(items) > ctype.length:
            raise ValueError(f"{len(items)} values for {ctype.cname}")
        return items
    return value


def _struct_of(value, ctype, held):
    if isinstance(value, ffi.CData):
        held.append(value)
        return value
    made = struct(ctype.cname, **value)
    held.append(made)
    return made[0]


def struct(name, /, **members):
    """A C struct, `struct("sph_sim_def", dim=2, dx=0.01)`: members that are not named are zero."""
    made, held = ffi.new(name + " *"), []
    known = dict(ffi.typeof(name).fields)
    for member, value in members.items():
        if member not in known:
            raise TypeError(f"{name} has no member '{member}'; it has {', '.join(known)}")
        setattr(made, member, to_c(value, known[member].type, held))
    return keep(made, *held)


def _argument(function, k, value, ctype, held):
    """Argument k of a function, whose name a mistake tells."""
    made = to_c(value, ctype, held)
    if ctype.kind == "primitive":
        try:
            ffi.new(ffi.getctype(ctype, "*"), made)
        except (TypeError, OverflowError) as problem:
            raise type(problem)(f"{_argument_name(function, k)}: {problem}") from None
    return made


def _argument_name(function, k):
    """"sph_eos_tait, c0", as the declarations have it."""
    for name in dir(lib):
        if name.startswith("sph_") and getattr(lib, name) == function:
            with open(declarations_path, encoding="utf-8") as file:
                found = re.search(rf"\b{name}\(([^()]*)\)", file.read())
            names = found[1].split(",") if found else []
            if k < len(names):
                return f"{name}, {re.split(r'[^A-Za-z0-9_]+', names[k].strip())[-1]}"
            return f"{name}, argument {k + 1}"
    return f"argument {k + 1}"


def call(function, *values):
    """function(*values) of the library, each value as its argument wants it."""
    wanted, held = ffi.typeof(function).args, []
    if len(values) > len(wanted):
        raise TypeError(f"{len(values)} arguments; wanted {len(wanted)}: "
                        f"{', '.join(t.cname for t in wanted)}")
    given = [_argument(function, k, v, t, held) for k, (v, t) in enumerate(zip(values, wanted))]
    for t in wanted[len(values):]:
        if t.kind != "pointer":
            raise TypeError(f"{len(values)} arguments; wanted {len(wanted)}: "
                            f"{', '.join(t.cname for t in wanted)}")
        given.append(ffi.NULL)
    result = function(*given)
    if isinstance(result, ffi.CData) and ffi.typeof(result).kind == "struct":
        keep(result, *held)
    return result
