#!/usr/bin/env bash
# The figures of docs/consistency.md again (also: make consistency): its tables on standard output, its pictures
# docs/consistency/lattice.png and jitter.png.  CONSISTENCY is the program, TO the folder of the pictures.  A minute.
set -euo pipefail
program=$(realpath "${CONSISTENCY:-$(dirname "$0")/../build/bench/consistency}")
cd "$(dirname "$0")/.."
to=${TO:-docs/consistency}
stage=$(mktemp -d)
trap 'rm -rf "$stage"' EXIT
export OMP_WAIT_POLICY=passive

picture() { # KIND TITLE
  "$program" "$1" >"$stage/$1"
  gnuplot <<END
set terminal pngcairo size 1000,640 font "sans,11"
set output "$to/$1.png"
set title "$2"
set logscale xy
set format y "10^{%L}"
set xlabel "spacing dx [m], box 1 m"
set ylabel "rms error over rms of the exact result"
set key outside right samplen 2
set xrange [1/150.:1/14.]
columns = "2 3 5 6 7 8 11 12 15 19 21 22 23"
plot for [c in columns] "$stage/$1" using 1:int(c) with linespoints title columnhead(int(c)), \
  x**2*30 with lines lc "gray" dt 2 title "order 2", x*3 with lines lc "gray" dt 3 title "order 1"
END
}

mkdir -p "$to"
picture lattice "Operators on a square lattice, Wendland C2, h = 1.6 dx"
picture jitter "Operators on a lattice with 20 % jitter, Wendland C2, h = 1.6 dx"
"$program"
