#!/usr/bin/env bash
# What measures and counts says so, and no more: make bench, bench/compare, check-instructions, check-aarch64 on made-up files.
source "$SRCDIR/tests/tap.sh"
compare=$SRCDIR/bench/compare

# ---- bench/compare

machine='{"sphode": "1.0", "cpu": "C", "isa": "I", "sizes": "full", "compiler": "gcc 12", "flags": "-O3"}'
figure() { # NAME VALUE SPREAD [RATIO]
  printf '{"name": "%s", "value": %s, "unit": "M/s", "spread": %s, "ratio": %s, "baseline": %s}\n' "$1" "$2" "$3" \
    "${4:-null}" "$([[ $# == 4 ]] && echo '"base"' || echo null)"
}
figures() { # FIGURE...: "NAME VALUE SPREAD [RATIO]"
  echo "$machine"
  # shellcheck disable=SC2086 # words of one figure
  for one; do figure $one; done
}
says() { # NAME PATTERN: the line of a figure
  grep -q "^$1  *$2\$" out
}
figures "rate 10 0.1 2" "noisy 10 0.3" "bits 0 0" "wrong 0 0" "bytes 1000 0" "grown 1000 0" "gone 1 0" >old
figures "rate 13 0.1 2.5" "noisy 11 0.1" "bits 0 0" "wrong 5 0" "bytes 1001 0" "grown 1020 0" "more 1 0" >a=b
run 0 "$compare" old a=b && says rate "10  *13 M/s  *1.300 \*   ratio to base 2 -> 2.5" && says noisy ".* 1.100" &&
  [[ ! -s err ]]
ok $? "differences beyond the spread have a star; a file's name may have ="
says bits "0  *0 M/s  *1.000" && says wrong "0  *5 M/s  *from 0 \*"
ok $? "equal values are equal, zero to something is told"
says bytes ".* 1.001" && says grown ".* 1.020 \*"
ok $? "of figures without a spread one percent counts"
grep -qx "gone: old only" out && grep -qx "more: new only" out && [[ $(wc -l <out) == 11 ]]
ok $? "figures of one run alone"
mv out table
sed 's/": /":/g; s/, /,/g' a=b >compact
run 0 "$compare" old compact && cmp -s out table
ok $? "the same without blanks"
sed 's/M\/s/s/' old >units
run 0 "$compare" old units && says rate "10  *10 s  *in M/s before.*"
ok $? "figures in other units are not divided"

run 0 "$compare" old old && grep -qx "new: C, I; full sizes; gcc 12 -O3" out && [[ $(grep -c " 1.000$" out) == 6 ]]
ok $? "a file and itself"

refused() { # NAME PATTERN FILE: as the old one and as the new one, and nothing is compared
  run 2 "$compare" "$3" old && grep -q "^compare: $3$2" err && [[ ! -s out ]] &&
    run 2 "$compare" old "$3" && grep -q "^compare: $3$2" err && [[ ! -s out ]]
  ok $? "$1"
}
: >empty
refused "an empty file" ": has no figures" empty
echo "$machine" >machine
refused "a run without figures" ": has no figures" machine
refused "a file that is not there" ": cannot be read" nothing
{ cat old && echo "rhs/3d  10 M/s +- 3 %"; } >lines
refused "a line of a table, with its number" ':9: "rhs/3d' lines
head -c 400 /dev/zero | tr '\0' '\377' >bytes
refused "bytes that are no text" ':1: "????' bytes
tr '\n' , <old >array
refused "all figures in a line" ":1: " array
sed 's/13/x/' a=b >words
refused "a value that is no number" ':2: rate: its value is "x", wanted a number' words
cat old old >twice
refused "a figure twice" ":10: rate stands there twice" twice
run 2 "$compare" old && grep -q "bench/compare OLD.json NEW.json" err
ok $? "one file alone is an error of use"

# ---- make bench: the rule, with another program

{
  sed -n '/^BENCHFLAGS =/,/^$/p' "$SRCDIR/build-aux/targets.am"
  printf 'bench/bench:\n\tmkdir -p bench\n\techo "echo figures of \\$$*" >$@\n\tchmod +x $@\n'
} >Makefile
run 0 env -u MAKEFLAGS -u MAKELEVEL -u MFLAGS "${MAKE:-make}" bench BENCHFLAGS=--json && [[ $(cat out) == "figures of --json" ]] &&
  grep -q "^mkdir" err
ok $? "make bench: figures alone on standard output, also where it builds"

# ---- check-instructions: compiler, valgrind, callgrind_annotate made up

mkdir bin build build-aux
export PATH=$stage/bin:$PATH
program() { cat >"$1" && chmod +x "$1"; }
program bin/gcc <<'END'
#!/bin/sh
case "$*" in *-dumpfullversion*) echo 12.2.0 ;; *-dM*) cat "$macros" ;; esac
END
program bin/uname <<<'echo x86_64'
program bin/callgrind_annotate <<<"cat '$stage/counts'"
program build/libtool <<<''
export macros=$stage/macros
echo '#define __GNUC__ 12' >macros
printf 'CC = gcc\nCFLAGS = -O3\nSUNDIALS_VERSION = 7\nbench/instructions:\n' >build/Makefile
cp "$SRCDIR/build-aux/check-instructions" build-aux
counted() { # FLUID STEPS: what callgrind tells
  printf '%s (50.0%%)  f.c:%s [/lib/x]\n' "$1" fluid_SPH_KERNEL_A_1_molteni "$2" steps_leapfrog >counts
}
check() { # STATUS [--write]
  run "$1" env -u MAKEFLAGS -u MAKELEVEL -u MFLAGS build-aux/check-instructions "${@:2}" build
}
counted 1,000 10,000
check 0 --write && grep -qx "# made by gcc 12.2.0, -O3, SUNDIALS 7" build-aux/instructions.txt &&
  grep -qx "steps_leapfrog 10000" build-aux/instructions.txt && check 0 && grep -q "2 counts within 3 %" out
ok $? "counts are written and found again"
counted 1,029 9,710
check 0
ok $? "within three percent"
counted 1,031 10,000
check 1 && grep -q "^fluid_SPH_KERNEL_A_1_molteni: 1031 instructions, +3.1 %" out && grep -q "WRITE=--write" out
ok $? "more fails"
counted 1,000 9,000
check 1 && grep -q "^steps_leapfrog: 9000 instructions, -10.0 %" out && grep -q "WRITE=--write" out && ! grep -q within out
ok $? "less fails as well: what was gained could be lost unseen"
counted 1,000 10,000
sed -i 's/steps_leapfrog/steps_other/' counts
check 1 && grep -q "steps_other: not in the file" out && grep -q "steps_leapfrog: did not run" out
ok $? "a name is missing here, one there"
counted 1,000 10,000
sed -i 's/^CC = .*/CC = env gcc -m64/' build/Makefile
check 0 && grep -q within out
ok $? "a compiler behind another command, with an option"
sed -i 's/^CC = .*/CC = gcc -march=native/' build/Makefile
check 77 && grep -q "skipped: made by gcc 12.2.0, -march=native -O3" out
ok $? "options of the compiler are its flags"
echo '#define __clang__ 1' >>macros
check 77 && grep -q "skipped: .* is not gcc" out
ok $? "clang is not gcc"

# ---- check-aarch64: a compiler that only names what it was given

program bin/fake-cc <<'END'
#!/bin/sh
echo "$@" >>"$calls"
case "$*" in "-static -x"*) cat >/dev/null ;; esac
while [ "$1" != -o ]; do shift; done
echo >"$2"
END
export calls=$stage/calls
mkdir -p here/objects "with blanks" tree/build-aux
touch here/old.o here/objects/old.o
ln -s "$SRCDIR"/{src,include,tests} tree
cp "$SRCDIR/build-aux/check-aarch64" tree/build-aux
run 0 env CC=fake-cc RUN=true tree/build-aux/check-aarch64 here && [[ -s here/test_lanes && -s here/objects/kernel_.o ]] &&
  grep -q "test_lanes.*/fluid_loops_generic.o" calls && ! grep -q "/old\.o" calls && [[ ! -e tree/here ]]
ok $? "a relative folder is one of where it was called; only what was compiled is linked"
run 0 env CC=fake-cc RUN=true tree/build-aux/check-aarch64 "with blanks" && [[ -s "with blanks/test_lanes" ]]
ok $? "a folder with a blank"
run 2 tree/build-aux/check-aarch64 && grep -q "check-aarch64 FOLDER" err
ok $? "no folder is an error of use"
echo "1..$count"
