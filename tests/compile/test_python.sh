#!/usr/bin/env bash
# The Python package on the library of this build; skipped without a Python that has what it needs.
stage=$(mktemp -d) || exit 99
trap 'rm -rf "$stage"' EXIT
cd "$stage" || exit 99

for python in "${PYTHON:-python3}" /usr/bin/python3 none; do
  "$python" -c 'import cffi, numpy, h5py' 2>/dev/null && break
done
[[ $python == none ]] && echo "1..0 # SKIP no Python with cffi, numpy and h5py (Debian: python3-cffi python3-numpy python3-h5py)" && exit
library=$(sed -n "s/^dlname='\(.*\)'/\1/p" "$BUILDDIR/libsphode.la")
export SPHODE_LIBRARY=$BUILDDIR/.libs/$library SPHODE_DECLARATIONS=$BUILDDIR/declarations.h
export PYTHONPATH=$SRCDIR/python PYTHONDONTWRITEBYTECODE=1 MPLCONFIGDIR=$stage
"$python" "$SRCDIR/tests/python/test_bindings.py" "$BUILDDIR" "$SRCDIR"
