#!/usr/bin/env bash
# Versions and names that stand in several places are the same; recipes can be read by their languages.
stage=$(mktemp -d) || exit 99
trap 'rm -rf "$stage"' EXIT
cd "$stage" || exit 99
cp -r "$SRCDIR/packaging" . && chmod -R u+w packaging

count=0
try() { # name, command...
  local name=$1
  shift
  count=$((count + 1))
  if "$@" >log 2>&1; then echo "ok $count - $name"; else echo "not ok $count - $name"; fi
  sed 's/^/# /' log | head -n 20
}
skip() { echo "ok $((++count)) - $1 # SKIP $2"; }

soname() { # libsphode.so.3: libsphode3
  local name
  name=$(sed -n "s/^dlname='libsphode\.so\.\([0-9]*\)'/libsphode\1/p" "$BUILDDIR/libsphode.la")
  [[ -z $name ]] && return # another system's names
  echo "$name" && grep -qx "Package: $name" packaging/debian/control && [[ -e packaging/debian/$name.install ]] &&
    ! grep -oE 'libsphode[0-9]+' packaging/debian/control packaging/debian/*.lintian-overrides packaging/README.md | grep -v ":$name\$"
}
released() { # checksum and address come into both recipes
  echo content >sphode-1.2.3.tar.gz
  local sum
  sum=$(sha256sum sphode-1.2.3.tar.gz | cut -d ' ' -f 1)
  packaging/release https://host.example/get/sphode-1.2.3.tar.gz sphode-1.2.3.tar.gz || return
  grep -qF "version(\"1.2.3\", sha256=\"$sum\")" packaging/spack/package.py &&
    grep -qF "sha256 \"$sum\"" packaging/homebrew/sphode.rb &&
    [[ $(grep -l '"https://host.example/get/sphode-1.2.3.tar.gz"' packaging/*/* | wc -l) == 2 ]]
}
python() { python3 -c 'import ast, sys; ast.parse(open(sys.argv[1]).read())' packaging/spack/package.py; }
changelog() { dpkg-parsechangelog -l packaging/debian/changelog -S Version | grep -E '^[0-9.]+-1$'; }
abi_numbers() { # current:revision:age, from which the file names follow
  local c r a
  IFS=: read -r c r a < <(sed -n 's/.*SPH_LIBRARY_VERSION\], \[\([0-9:]*\)\].*/\1/p' "$SRCDIR/configure.ac")
  grep -q "libsphode\.so\.$((c - a))\.$a\.$r" "$BUILDDIR/libsphode.la" || ! grep -q 'libsphode\.so' "$BUILDDIR/libsphode.la"
}

try "Debian's names follow the soname" soname
try "the soname follows the number of the interface" abi_numbers
command -v sha256sum >/dev/null && try "a release is written into the recipes" released || skip "a release" "no sha256sum"
command -v python3 >/dev/null && try "the Spack recipe is Python" python || skip "the Spack recipe" "no python3"
command -v dpkg-parsechangelog >/dev/null && try "Debian's changelog can be read" changelog || skip "Debian's changelog" "no dpkg-dev"
command -v ruby >/dev/null && try "the Homebrew formula is Ruby" ruby -c packaging/homebrew/sphode.rb || skip "the Homebrew formula" "no ruby"
echo 1..$count
