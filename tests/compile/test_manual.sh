#!/usr/bin/env bash
# The manual pages name every command, option, header and function, and are well formed.
stage=$(mktemp -d) || exit 99
trap 'rm -rf "$stage"' EXIT
cd "$stage" || exit 99
page=$BUILDDIR/man/sphode.1
[[ -e $page ]] || page=$SRCDIR/man/sphode.1
pages=("$page" "$BUILDDIR"/man/sphode*.3)

count=0
try() { # name, command...
  local name=$1
  shift
  count=$((count + 1))
  if "$@" >log 2>&1; then echo "ok $count - $name"; else echo "not ok $count - $name"; fi
  sed 's/^/# /' log | head -n 20
}
program() { # every word of the help stands on the page
  local command words
  sed 's/\\-/-/g; s/\\e/\\/g; s/\\&//g' "$page" >plain
  tr -s ' \n' '\n' <plain >words
  commands=$("$BUILDDIR/sphode" help | awk '/^  [a-z-]+ +[][A-Z]/ && $1 != "sphode" { print $1 }')
  (($(wc -w <<<"$commands") > 7)) || return
  for command in $commands; do
    grep -q "^\.SS \"sphode $command " plain || { echo "no section on $command" && return 1; }
    for words in $("$BUILDDIR/sphode" "$command" --help | tail -n +4 | tr -d '"'); do
      tr -d '"' <words | grep -qxF -- "$words" || { echo "$command: '$words' is missing" && return 1; }
    done
  done
  (($(grep -c '^\.TP' plain) > 30))
}
headers() {
  local header name
  for header in "$SRCDIR"/include/sphode/*.h; do
    name=sphode_$(basename "$header" .h)
    grep -q "^\.BR $name (3)" "$BUILDDIR/man/sphode.3" || { echo "sphode(3) lacks $name" && return 1; }
    grep -qE "^$name(,| )" "$BUILDDIR/man/$name.3" || { echo "$name(3) lacks its name" && return 1; }
  done
}
functions() {
  local function
  cat "$BUILDDIR"/man/sphode_*.3 | sed -n '/^\.SH NAME/,/^\.SH SYNOPSIS/p' | tr -s ', ' '\n' >names
  for function in $(grep -hoE '\bsph_[a-z0-9_]+\(' "$BUILDDIR/declarations.h" | tr -d '(' | sort -u); do
    grep -qx "$function" names || { echo "$function is in no NAME" && return 1; }
  done
  (($(grep -c '^sph_' names) > 250))
}
statuses() {
  local status
  for status in $(grep -oE '\bX\(SPH_ERR_[A-Z]+' "$SRCDIR/include/sphode/base.h" | cut -c3-); do
    grep -q "^| \`$status\` |" "$SRCDIR/docs/output.md" || { echo "$status is not in docs/output.md" && return 1; }
  done
  [[ -n $status ]]
}
groff_says() {
  local file said
  for file in "${pages[@]}"; do
    said=$(LC_ALL=C.UTF-8 MANROFFSEQ='' MANWIDTH=120 man --warnings -E UTF-8 -l -Tutf8 -Z "$file" 2>&1 >/dev/null)
    [[ -z $said ]] || { echo "$file: $said" && return 1; }
  done
}
mandoc_says() { mandoc -T lint -W warning "${pages[@]}"; }

try "sphode(1) has what the program's help has" program
try "headers have pages, and sphode(3) lists them" headers
try "functions are found by their names" functions
try "statuses are in the manual" statuses
if command -v groff >/dev/null && man --warnings -l -Tutf8 -Z "${pages[0]}" >/dev/null 2>&1; then
  try "man --warnings says nothing" groff_says
else
  echo "ok $((++count)) - man --warnings # SKIP no groff or no man (Debian: groff-base man-db)"
fi
if command -v mandoc >/dev/null; then
  try "mandoc finds nothing" mandoc_says
else
  echo "ok $((++count)) - mandoc # SKIP no mandoc"
fi
echo 1..$count
