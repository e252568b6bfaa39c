# Cost of finding contacts. Usage: gnuplot -c cases/contact/plot.gp DIR; reads DIR/figures.txt, writes DIR/contact.png.
if (ARGC != 1) { print "usage: gnuplot -c cases/contact/plot.gp DIR"; exit status 2 }
of(radius, key) = sprintf("< awk '$2 == \"n\" {n = $3} $1 ~ /^r%d-/ && $2 == \"%s\" {print n, $3}' '%s/figures.txt' | sort -n", radius, key, ARG1)
set terminal pngcairo size 1100, 460 font "sans,11"
set output ARG1 . "/contact.png"
set multiplot layout 1, 2
set grid
set logscale xy
set yrange [0.001:*]
set key top left
set xlabel "discs"
set ylabel "ms a search"
do for [radius in "2 5"] {
  set title sprintf("Fig. 6: cost of a search for contacts, R = %d", radius + 0)
  plot of(radius + 0, "grid_ms") with linespoints pointtype 7 title "by the grid", \
       of(radius + 0, "linked200_ms") with linespoints pointtype 6 title "linked cells of 200 x 200 (the paper's)", \
       of(radius + 0, "linked_tuned_ms") with linespoints pointtype 4 title "linked cells of one diameter"
}
unset multiplot
