#!/usr/bin/env bash
# The library exports only sph_*, the object of x.c only sph_x*.
echo 1..1
if "$SRCDIR/build-aux/check-symbols" "$SRCDIR" "$BUILDDIR" | sed 's/^/# /' && ((PIPESTATUS[0] == 0)); then
  echo "ok 1 - exported names"
else
  echo "not ok 1 - exported names"
fi
