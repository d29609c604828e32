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

# All operators, a panel a kind; colours and symbols are those of a place in its panel.
picture() { # KIND TITLE
  "$program" "$1" >"$stage/$1"
  gnuplot <<END
set terminal pngcairo size 1500,820 font "sans,11"
set output "$to/$1.png"
set border 3 lc rgb "#666666"
set tics nomirror out scale 0.6
set grid lc rgb "#e4e4e4" lt 1
set logscale xy
set format y "10^{%T}"
set xtics ("1/16" 1/16., "1/32" 1/32., "1/64" 1/64., "1/128" 1/128.)
set xrange [1/150.:1/14.]
set xlabel "spacing dx [m], box 1 m"
set key outside bottom center horizontal Left reverse samplen 2 maxcols 2 height 1.5
colours = "#31688e #d1495b #35b779 #6b4c9a #e08e0b #17becf #a6761d #e377c2 #1a1a1a #7f9c3a #9aa5b1 #b2182b"
shapes = "7 5 9 11 13 15 6 4 8 10 12 14"
set bmargin 14
set multiplot layout 1,3 title "$2" font ",13"
do for [panel = 0:2] {
  first = int(word("2 7 19", panel + 1)); last = int(word("6 18 25", panel + 1))
  set title panel == 0 ? "values" : panel == 1 ? "gradients, divergence, curl" : "second derivatives"
  set ylabel panel ? "" : "rms error over rms of the exact result"
  plot for [c = first:last] "$stage/$1" using 1:c with linespoints lc rgb word(colours, c - first + 1) \
      pt int(word(shapes, c - first + 1)) lw 1.4 title columnhead(c), \
    x**2*30 with lines lc rgb "#888888" dt 2 title "order 2", x*3 with lines lc rgb "#888888" dt 3 title "order 1"
}
unset multiplot
END
}

mkdir -p "$to"
picture lattice "Operators on a square lattice, Wendland C2, h = 1.6 dx"
picture jitter "Operators on a lattice with 20 % jitter, Wendland C2, h = 1.6 dx"
"$program"
