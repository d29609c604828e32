#!/usr/bin/env bash
# Every test has a log of its own: of test_x and test_x.sh, which would share one, only one would run.
unset MAKEFLAGS MAKELEVEL MFLAGS # or it would tell of folders and jobs
echo 1..1
twins=$($MAKE -s --no-print-directory -C "$BUILDDIR" print-tests | tr ' ' '\n' | grep '^tests/' | sed 's/\.sh$//' | sort | uniq -d)
[[ -z $twins ]] || echo "# twice: $twins"
[[ -z $twins ]] && echo "ok 1 - names of tests" || echo "not ok 1 - names of tests"
