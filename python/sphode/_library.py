"""The C library: where it is, its declarations, and its errors as exceptions.

Nothing is compiled: cffi opens the library and reads the declarations that were installed with it,
the headers behind the C preprocessor.
"""
import os
import subprocess

import cffi


class Error(RuntimeError):
    """A failure in the library: its text, the status (-1, ...) and its name ("SPH_ERR_ARGUMENT")."""

    def __init__(self, text, status):
        super().__init__(text)
        self.status = status
        self.name = _names.get(status, str(status))


def _pkg_config(variable):
    command = [os.environ.get("PKG_CONFIG", "pkg-config"), "--variable=" + variable, "sphode"]
    try:
        return subprocess.run(command, capture_output=True, text=True, check=False).stdout.strip()
    except OSError:
        return ""


def _find():
    """(shared library, declarations): of the environment, of this installation, of pkg-config."""
    library, declarations = (os.environ.get(name) for name in
                             ("SPHODE_LIBRARY", "SPHODE_DECLARATIONS"))
    if library and declarations:
        return library, declarations
    try:
        from . import _installed
        return _installed.LIBRARY, _installed.DECLARATIONS
    except ImportError:
        pass
    library, declarations = _pkg_config("library"), _pkg_config("declarations")
    if library and declarations:
        return library, declarations
    raise ImportError("no installed sphode: pkg-config knows none (PKG_CONFIG_PATH=DIR/lib/pkgconfig "
                      "where it is in DIR), or give SPHODE_LIBRARY=.../libsphode.so and "
                      "SPHODE_DECLARATIONS=.../share/sphode/declarations.h")


def _open():
    library, declarations = _find()
    made = cffi.FFI()
    try:
        with open(declarations, encoding="utf-8") as file:
            text = file.read()
        made.cdef(text)
        opened = made.dlopen(library)
    except (OSError, cffi.CDefError) as problem:
        raise ImportError(f"sphode: {problem}") from problem
    found = made.string(opened.sph_version()).decode()
    wanted = text.split('"')[1] if text.startswith('/* sphode "') else found
    if found != wanted:
        raise ImportError(f"{library} is version {found}, but {declarations} are of {wanted}; right is "
                          "both of one installation")
    return made, opened, found, library, declarations


ffi, lib, version, library_path, declarations_path = _open()
_names = {getattr(lib, name): name for name in dir(lib) if name == "SPH_OK" or name == "SPH_RETRY"
          or name.startswith("SPH_ERR_")}


def text_of(pointer):
    """The str of a char *; None of NULL."""
    return ffi.string(pointer).decode() if pointer != ffi.NULL else None


def listed(function):
    """The names that function(0), function(1), ... give, up to NULL."""
    names, k = [], 0
    while (name := text_of(function(k))) is not None:
        names.append(name)
        k += 1
    return names
