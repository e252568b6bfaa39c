# The maps as pictures. Usage: gnuplot -c bench/stability.gp REPORT.json PICTURE.png
# The report is that of `delbm bench stability --json`: one row of a map a line.
if (ARGC != 2) { print "usage: gnuplot -c bench/stability.gp REPORT.json PICTURE.png"; exit status 2 }
set terminal pngcairo size 1400, 1500 font "sans,9" noenhanced
set output ARG2
# x, y, verdict (0 completed, 1 inaccurate, 2 diverged), label of the column, label of the row, with tabs between
places(map) = sprintf("< awk -v OFS='\\t' -v map='\"%s\": {' '" . \
  "index($0, \"\\\"value\\\": \\\"\") { on = index($0, map); y = 0; sub(/.*\"columns\": \\[/, \"\"); sub(/\\].*/, \"\"); gsub(/[\" ]/, \"\"); split($0, column, \",\"); next } " . \
  "on && match($0, /\"[^\"]*\": \\[/) { row = substr($0, RSTART + 1, RLENGTH - 5); n = split($0, place, \"{\"); " . \
  "for (k = 2; k <= n; k++) print k - 2, y, (place[k] ~ /diverged/ ? 2 : place[k] ~ /inaccurate/ ? 1 : 0), column[k - 1], row; y++ }' '%s'", map, ARG1)
set datafile separator tab
set palette defined (0 "#3a9a5b", 1 "#e8b23a", 2 "#b8322a")
set cbrange [0:2]
unset colorbox
set key off
set offsets 0.6, 0.6, 0.6, 0.6
set tics scale 0
set xtics rotate by 45 right
draw(map, corner) = sprintf("set title '%s'; set xlabel '%s'; plot places('%s') using 1:2:3:xtic(4):ytic(5) with points pointtype 5 pointsize 2.4 linecolor palette", map, corner, map)
set multiplot layout 5, 4 title "Stability. Green: completed, amber: inaccurate, red: diverged. Rows: viscosity, or as the title says"
do for [operator in '"bgk" "trt 3/16" "mrt 1.4 1.2" "mrt s_nu 1.2" "mrt 1.4 magic 3/16" "adaptive"'] {
  eval draw("shear layer, " . operator, "Mach number")
}
do for [operator in '"bgk" "trt 3/16" "mrt 1.4 1.2" "mrt s_nu 1.2" "mrt 1.4 magic 3/16" "adaptive"'] {
  eval draw("driven disc, " . operator, "Mach number")
}
eval draw("density of a settling disc", "density")
eval draw("fixed disc that spins", "spin")
eval draw("fixed disc under a lid", "Mach number of the lid")
eval draw("impact, damping 0.34, restitution", "sub-steps (rows: stiffness)")
set xrange [-0.6:0.6] # one column
eval draw("impact by cells, damping 0.34, restitution", "sub-steps (rows: stiffness)")
set autoscale x
eval draw("fast impact, overlap", "Mach number of each (rows: density)")
eval draw("packing pressed by its weight", "weight (rows: stiffness)")
eval draw("small discs on a large one", "ratio of radii (rows: stiffness)")
unset multiplot
