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

# What else is where it belongs, and nothing is beside the prefix.
places() {
  local share=${pc%/lib*}/share prefix
  prefix=$("$PKG_CONFIG" --variable=prefix "$pc/sphode.pc")
  find "$stage" -type f ! -path "$stage$prefix/*" ! -path "$stage/program*" ! -path "$stage/log" | grep . && return 1
  for file in man/man1/sphode.1 man/man3/sphode.3 man/man3/sphode_group.3 bash-completion/completions/sphode \
    zsh/site-functions/_sphode sphode/declarations.h sphode/sphode.f90 sphode/cases/sod-1d.yml; do
    [[ -s $share/$file ]] || { echo "no $share/$file" && return 1; }
  done
}

echo 1..10
try "make install into a stage" env -u MAKEFLAGS -u MAKELEVEL "$MAKE" -C "$BUILDDIR" install DESTDIR="$stage"
pc=$(dirname "$(find "$stage" -name sphode.pc)")
library=$(dirname "$pc")
try "pkg-config knows it" config --exists --print-errors sphode
try "manual, completion, declarations, cases are in the prefix" places
try "it compiles and links" $CC $(config --cflags sphode) -o "$stage/program" "$stage/program.c" $(config --libs sphode)
try "it runs" program
try "the installed program runs" env LD_LIBRARY_PATH="$library:${LD_LIBRARY_PATH:-}" "$(find "$stage" -path '*/bin/sphode')" --version

# Examples that drive other solvers, by the line in their heads; SUNDIALS itself may live outside of the stage.
solvers() { PKG_CONFIG_PATH=$pc "$PKG_CONFIG" --define-variable=prefix="${pc%/lib*}" "$@" sphode-sundials; }
for example in arkode gsl; do
  more=
  [[ $example == gsl ]] && more=$("$PKG_CONFIG" --cflags --libs gsl)
  try "08_drive_$example compiles and links" $CC $(solvers --cflags) -o "$stage/program" \
    "$SRCDIR/examples/08_drive_$example.c" $(solvers --libs) $more
  try "it runs" program
done
