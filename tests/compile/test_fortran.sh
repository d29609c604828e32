#!/usr/bin/env bash
# The Fortran module: members lie where C has them, and its examples say what those in C say.
stage=$(mktemp -d) || exit 99
trap 'rm -rf "$stage"' EXIT
cd "$stage" || exit 99
FC=${FC:-gfortran}
command -v "$FC" >/dev/null || { echo "1..0 # SKIP no Fortran compiler ($FC; Debian: gfortran)" && exit; }

count=0
try() { # name, command...
  local name=$1
  shift
  count=$((count + 1))
  if "$@" >log 2>&1; then echo "ok $count - $name"; else echo "not ok $count - $name"; fi
  sed 's/^/# /' log | head -n 40
}
module=$BUILDDIR/fortran/sphode.f90
export LD_LIBRARY_PATH=$BUILDDIR/.libs:${LD_LIBRARY_PATH:-}
compiles() { # SOURCE PROGRAM
  "$FC" -std=f2018 -Wall -Werror -Wno-c-binding-type -o "$2" sphode.o "$1" -L"$BUILDDIR/.libs" -lsphode
}

# Sizes and offsets of all types of the module, from both compilers.
layout() {
  awk -v c=layout.c -v f=layout.f90 '
    function both(label, in_c, in_f) {
      printf "  printf(\"%s %%zu\\n\", %s);\n", label, in_c >c
      printf "  write (*, \"(a,1x,i0)\") \"%s\", %s\n", label, in_f >f
    }
    BEGIN {
      print "#include <sphode.h>\n#include <stddef.h>\n#include <stdio.h>\nint main(void)\n{" >c
      print "program layout\n  use sphode\n  implicit none" >f
    }
    /^  type, bind\(C\)/ { type = $4; types[++n] = type; printf "  type(%s), target :: x%d\n", type, n >f; next }
    /^  end type/ { type = "" }
    type && / :: / { sub(/.* :: /, ""); sub(/[ (].*/, ""); members[n] = members[n] " " $0 }
    END {
      for (k = 1; k <= n; k++) {
        both(types[k], "sizeof(" types[k] ")", sprintf("c_sizeof(x%d)", k))
        m = split(members[k], name, " ")
        for (i = 1; i <= m; i++) {
          plain = name[i]; sub(/_upper$/, "", plain)
          if (plain == "text" && types[k] == "sph_error") continue # c_loc wants no character of any length
          both(types[k] "." plain, "offsetof(" types[k] ", " plain ")",
               sprintf("at(c_loc(x%d%%%s)) - at(c_loc(x%d))", k, name[i], k))
        }
      }
      print "  return 0;\n}" >c
      print "contains\n  integer(c_intptr_t) function at(p)\n    type(c_ptr), intent(in) :: p" >f
      print "    at = transfer(p, at)\n  end function\nend program" >f
    }' "$module" &&
    $CC -I "$SRCDIR/include" layout.c -o layout_c && "$FC" -o layout_f sphode.o layout.f90 &&
    ./layout_c >layout_c.txt && ./layout_f >layout_f.txt && diff layout_c.txt layout_f.txt &&
    (($(wc -l <layout_c.txt) > 250)) && echo "$(wc -l <layout_c.txt) sizes and offsets"
}
functions() { # of sphode.h: all but those with "..." and one that returns a pointer to arrays
  local declared
  declared=$(grep -cE '^(const )?[a-z_]+ \**\(?\*?sph_[a-z0-9_]+\(' "$BUILDDIR/declarations.h")
  found=$(grep -cE '^    end (function|subroutine)' "$module")
  echo "$found of $declared" && ((found >= declared - 3 && found > 200))
}
kernel() { ./f_kernel | grep -q "All integrals are 1"; }
neighbors() { ./f_neighbors; }
same_front() {
  ./f_dam_break 20 | sed 's/\([^0-9]\)\./\10./g' >fortran.txt
  "$BUILDDIR/examples/03_dam_break" 20 >c.txt
  diff c.txt fortran.txt && grep -q front c.txt
}
own_force() { ./f_dam_break 20 own && ! ./f_dam_break 20 own | grep -qF "$(./f_dam_break 20)"; }

try "the module compiles without warnings" "$FC" -std=f2018 -Wall -Werror -c "$module"
try "every function is in it" functions
try "types have the layout of C" layout
for example in kernel neighbors dam_break; do
  try "$example compiles" compiles "$SRCDIR/fortran/examples/$example.f90" "f_$example"
done
try "kernel: integrals are 1" kernel
try "neighbors: as many as there should be" neighbors
try "dam_break: the front of the example in C" same_front
try "dam_break: a force in Fortran" own_force
echo 1..$count
