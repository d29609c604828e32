#!/usr/bin/env bash
# A program outside the tree finds the installed sphode through pkg-config, compiles, links and runs.
stage=$(mktemp -d) || exit 99
trap 'rm -rf "$stage"' EXIT
cat >"$stage/program.c" <<'END'
#include <sphode.h>
#include <stdio.h>
int main(void) { return puts(sph_version()) < 0; }
END

count=0
try() { # name, command...
  local name=$1
  shift
  count=$((count + 1))
  if "$@" >"$stage/log" 2>&1; then echo "ok $count - $name"; else echo "not ok $count - $name"; fi
  sed 's/^/# /' "$stage/log"
}
config() { PKG_CONFIG_SYSROOT_DIR=$stage PKG_CONFIG_PATH=$pc "$PKG_CONFIG" "$@"; }
program() { LD_LIBRARY_PATH=$library:${LD_LIBRARY_PATH:-} "$stage/program"; }

echo 1..5
try "make install into a stage" env -u MAKEFLAGS -u MAKELEVEL "$MAKE" -C "$BUILDDIR" install DESTDIR="$stage"
pc=$(dirname "$(find "$stage" -name sphode.pc)")
library=$(dirname "$pc")
try "pkg-config knows it" config --exists --print-errors sphode
try "it compiles and links" $CC $(config --cflags sphode) -o "$stage/program" "$stage/program.c" $(config --libs sphode)
try "it runs" program
try "the installed program runs" env LD_LIBRARY_PATH="$library:${LD_LIBRARY_PATH:-}" "$(find "$stage" -path '*/bin/sphode')" --version
