# SPH_CHECK_PYTHON
# Whether python/sphode is installed, and where: sets PYTHON, pythondir, sph_python (for the summary)
# and the conditional SPH_PYTHON.  Nothing is built; cffi and numpy are wanted where it is used.
AC_DEFUN([SPH_CHECK_PYTHON], [
AC_ARG_ENABLE([python],
  [AS_HELP_STRING([--enable-python], [install the Python package (default: where there is a Python 3.8 or later)])],
  [], [enable_python=auto])
AC_ARG_VAR([PYTHON], [Python that the package is installed for])
AC_ARG_VAR([pythondir], [where the Python package goes (default: a place in the prefix where PYTHON looks)])
sph_python=no
AS_IF([test "x$enable_python" != xno], [
  AC_PATH_PROGS([PYTHON], [python3 python], [:])
  AS_IF(["$PYTHON" -c 'import sys; sys.exit(sys.version_info < (3, 8))' >/dev/null 2>&1 && test "$PYTHON" != :],
    [sph_python=yes])
  AS_IF([test "$enable_python,$sph_python" = yes,no], [AC_MSG_ERROR([--enable-python: no Python 3.8 or later])])])
sph_python_about="no: no Python 3.8 or later"
AS_IF([test "x$enable_python" = xno], [sph_python_about="no: --disable-python"])
AS_IF([test $sph_python = yes], [
  sph_prefix=$prefix
  AS_IF([test "x$sph_prefix" = xNONE], [sph_prefix=$ac_default_prefix])
  # Of the places where this Python looks the first inside of the prefix; else the usual one, for PYTHONPATH.
  AS_IF([test "x$pythondir" = x], [
    pythondir=`"$PYTHON" - "$sph_prefix" <<'END'
import os, sys
prefix = os.path.normpath(sys.argv[[1]])
there = [[p for p in sys.path if os.path.basename(p) in ("site-packages", "dist-packages")
         and os.path.normpath(p).startswith(prefix + os.sep)]]
usual = os.path.join(prefix, "lib", "python%d.%d" % sys.version_info[[:2]], "site-packages")
print('$''{prefix}' + (there + [[usual]])[[0]][[len(prefix):]])
END
`])
  sph_python_version=`"$PYTHON" -c 'import platform; print(platform.python_version())'`
  sph_python_about="$PYTHON ($sph_python_version), into $pythondir"
  "$PYTHON" -c 'import cffi, numpy' >/dev/null 2>&1 ||
    sph_python_about="$sph_python_about; it lacks cffi or numpy"])
AM_CONDITIONAL([SPH_PYTHON], [test $sph_python = yes])
])
