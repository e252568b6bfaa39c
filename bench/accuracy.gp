# Error against time, one panel a case. Usage: gnuplot -c bench/accuracy.gp REPORT.json PICTURE.png
# The report is that of `delbm bench accuracy --json`: one run a line.
if (ARGC != 2) { print "usage: gnuplot -c bench/accuracy.gp REPORT.json PICTURE.png"; exit status 2 }
set terminal pngcairo size 1250, 1120 font "sans,10"
set output ARG2
field(name) = sprintf("(match($0, /\"%s\": [^,}]*/) ? substr($0, RSTART + %d, RLENGTH - %d) : \"\")", name, strlen(name) + 4, strlen(name) + 4)
of(case) = sprintf("index($0, \"\\\"case\\\": \\\"%s\\\"\")", case)
by(choice) = sprintf("index($0, \"\\\"choice\\\": \\\"%s\\\"\")", choice)
runs(case, choice) = sprintf("< awk '%s && %s {print %s, %s}' '%s'", of(case), by(choice), field("seconds"), field("error"), ARG1)
front(case) = sprintf("< awk '%s && /\"best_for_time\": true/ {print %s, %s}' '%s' | sort -g", of(case), field("seconds"), field("error"), ARG1)
array operators[6] = ["bgk", "trt", "mrt", "mrt + 3/16", "mrt + 1/12", "adaptive"]
array colours[6] = ["#7a7a7a", "#2170be", "#c2481a", "#2a9d4b", "#8a3fb0", "#000000"]
# circles: midpoint, or no discs; triangles: owen; squares: unified. Filled: double; open: single.
array forms[8] = ["", "", "midpoint, ", "midpoint, ", "owen, ", "owen, ", "unified, ", "unified, "]
array precisions[2] = ["double", "single"]
array types[8] = [7, 6, 7, 6, 9, 8, 5, 4]
set logscale xy
set format xy "10^{%T}"
set xlabel "seconds"
set ylabel "error"
set grid
set key off
set multiplot layout 3, 3 title "Error against time. Filled: double, open: single. Circles: midpoint (or no discs), triangles: owen, squares: unified. Dashed: the best for their time"
do for [case in "taylor-green shear-layer poiseuille couette spin drag settling crossing"] {
  set title case
  with_discs = strstrt("spin drag settling crossing", case) > 0
  plot front(case) with lines dashtype 2 linecolor rgb "black", \
       for [f = (with_discs ? 3 : 1):(with_discs ? 8 : 2)] for [k = 1:6] \
         runs(case, forms[f] . operators[k] . ", " . precisions[f % 2 ? 1 : 2]) \
         using 1:(valid(2) ? column(2) : NaN) with linespoints pointtype types[f] linecolor rgb colours[k]
}
set title "impact: lens (filled), cells (open)"
set key at graph 0.98, 0.98 right top
plot runs("impact", "lens") with linespoints pointtype 7 linecolor rgb "black" notitle, \
     runs("impact", "cells") with linespoints pointtype 6 linecolor rgb "black" notitle, \
     for [k = 1:6] NaN with points pointtype 7 linecolor rgb colours[k] title operators[k]
unset multiplot
