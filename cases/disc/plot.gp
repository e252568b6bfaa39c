# Drag against Reynolds number, and vorticity. Usage: gnuplot -c cases/disc/plot.gp DIR; DIR holds the runs of `runs`.
if (ARGC != 1) { print "usage: gnuplot -c cases/disc/plot.gp DIR"; exit status 2 }
reference = system("dirname '" . ARG0 . "'") . "/reference.csv"
figures = ARG1 . "/figures.txt"
pairs(y) = sprintf("< awk '$1 ~ /^nu/ && $2 == \"body.reynolds\" {re = $3} $1 ~ /^nu/ && $2 == \"body.%s\" {print re, $3}' '%s' | sort -n", y, figures)
of(kind) = sprintf("< awk -F, '$1 == \"%s\" {print $2, $3}' '%s'", kind, reference)

set terminal pngcairo size 760, 480 font "sans,11"
set output ARG1 . "/drag.png"
set title "Fig. 8: drag of a settling disc"
set logscale x
set grid
set xrange [10:400]
set yrange [0.5:3]
set xlabel "Re = U D/nu"
set ylabel "C_D"
plot pairs("drag") with linespoints pointtype 7 pointsize 1.2 linewidth 2 linecolor rgb "#c2481a" title "settling disc, C_D = pi R g (rho_s - rho)/(rho U^2)", \
     pairs("drag_printed") with linespoints pointtype 6 linecolor rgb "#e8a27f" title "settling disc, 8 R g (rho_s - rho)/(3 rho U^2)", \
     of("curve") with lines linewidth 2 linecolor rgb "#2170be" title "fixed cylinder, computed", \
     of("steady") with points pointtype 4 linecolor rgb "#2170be" title "fixed cylinder, steady, Fornberg 1980", \
     of("experiment") with points pointtype 2 linecolor rgb "black" title "experiment, Tritton 1959"

reset
set terminal pngcairo size 1000, 400 font "sans,10"
set output ARG1 . "/vorticity.png"
set multiplot layout 1, 5 title "Fig. 7: vorticity at step 14000"
unset tics
unset border
set size ratio -1
do for [nu in "0.05 0.025 0.02 0.01 0.005"] {
  set title "nu " . nu
  plot ARG1 . "/nu-" . nu . "/frames/00014000.png" binary filetype=png with rgbimage notitle
}
unset multiplot
