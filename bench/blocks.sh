#!/bin/sh
# docs/performance/blocks.png: a block of targets and the runs of its sources (bench/blocks.c).
set -e
BLOCKS=$(realpath "$BLOCKS")
cd "$(dirname "$0")/.."
data=$(mktemp)
trap 'rm -f "$data"' EXIT
"$BLOCKS" > "$data"
mkdir -p docs/performance
"${GNUPLOT:-gnuplot}" << END
set terminal pngcairo size 760,760 font 'sans,11'
set output 'docs/performance/blocks.png'
set size ratio -1
set xrange [5.5:20.5]
set yrange [5.5:20.5]
set xlabel 'x/dx'
set ylabel 'y/dx'
set key outside below
stats '$data' nooutput
last = STATS_blocks - 2
plot '$data' index 0 with lines lc rgb '#e4e4e4' title 'sorted order', \
     '' index 0 with points pt 7 ps 0.7 lc rgb '#b0b0b0' notitle, \
     for [k = 2:last] '' index k with linespoints pt 7 ps 1 lw 2 lc k title (k == 2 ? 'runs of sources, a colour each' : ''), \
     '' index 1 with points pt 6 ps 2 lw 2 lc rgb 'black' title 'the eight targets of a block', \
     '' index 1 using 1:2:(3.0) with circles lc rgb '#60000000' notitle
END
