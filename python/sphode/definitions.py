"""The library's constructors by their names: sphode.eos.tait(...) is sph_eos_tait(...)."""
from ._convert import call
from ._library import ffi, lib, text_of


class Constructors:
    """Functions PREFIX... of the library that make a definition; sequences, str and dict may be
    given where C wants arrays, texts and structs."""

    def __init__(self, prefix, made):
        self._prefix = prefix
        self._names = [name[len(prefix):] for name in dir(lib) if name.startswith(prefix)
                       and ffi.typeof(getattr(lib, name)).kind == "function"
                       and ffi.typeof(getattr(lib, name)).result.cname == made]

    def __dir__(self):
        return self._names

    def __getattr__(self, name):
        if name not in self._names:
            raise AttributeError(f"{self._prefix}{name}: no such function; there are "
                                 f"{', '.join(self._names)}")
        function = getattr(lib, self._prefix + name)

        def make(*values):
            return call(function, *values)
        make.__name__ = name
        make.__doc__ = f"{self._prefix}{name}: {ffi.typeof(function).cname}; see the headers."
        return make


eos = Constructors("sph_eos_", "sph_eos")
term = Constructors("sph_term_", "sph_term")
boundary = Constructors("sph_boundary_", "sph_boundary")
output = Constructors("sph_output_", "sph_output")
material = Constructors("sph_material_", "sph_material")


def members(cstruct):
    """What a definition holds, as a dict, for people."""
    kinds = dict(ffi.typeof(cstruct).fields)
    return {name: text_of(getattr(cstruct, name)) if "char *" in kind.type.cname
            else getattr(cstruct, name) for name, kind in kinds.items()
            if kind.type.kind == "primitive" or "char *" in kind.type.cname}
