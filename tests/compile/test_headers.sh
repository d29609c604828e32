#!/usr/bin/env bash
# Every public header compiles alone, as C11 and as C++17.
cd "$SRCDIR" || exit 99
headers=(include/sphode.h include/sphode/*.h)
count=0

# The one header that includes others than ours: with their flags, and not answerable for their warnings.
sundials=$(env -u MAKEFLAGS -u MFLAGS -u MAKELEVEL "$MAKE" -s --no-print-directory -C "$BUILDDIR" print-cppflags)

compiles() { # name, compiler and flags, header
  local flags="-Wall -Wextra -Werror"
  [[ $3 == */sundials.h ]] && flags="-w $sundials"
  count=$((count + 1))
  if $2 $flags -fsyntax-only -Iinclude -include "$3" /dev/null 2>&1 | sed 's/^/# /' &&
    ((PIPESTATUS[0] == 0)); then
    echo "ok $count - $3 as $1"
  else
    echo "not ok $count - $3 as $1"
  fi
}

echo "1..$((2 * ${#headers[@]}))"
for header in "${headers[@]}"; do
  compiles C11 "$CC -std=c11 -pedantic -x c" "$header"
  if [[ -n $CXX ]]; then
    compiles C++17 "$CXX -std=c++17 -x c++" "$header"
  else
    echo "ok $((++count)) - $header as C++17 # SKIP no C++ compiler"
  fi
done
