# Cost of finding contacts. Usage: gnuplot -c cases/contact/plot.gp DIR; reads DIR/figures.txt, writes DIR/contact.png.
if (ARGC != 1) { print "usage: gnuplot -c cases/contact/plot.gp DIR"; exit status 2 }
of(key) = sprintf("< awk '$2 == \"n\" {n = $3} $1 ~ /^r/ && $2 == \"%s\" {print n, $3}' '%s/figures.txt' | sort -n", key, ARG1)
set terminal pngcairo size 700, 460 font "sans,11"
set output ARG1 . "/contact.png"
set title "Fig. 6: cost of contacts a step"
set grid
set logscale xy
set key top left
set xlabel "discs"
set ylabel "ms a step"
plot of("grid_ms") with linespoints pointtype 7 title "by the grid", \
     of("linked200_ms") with linespoints pointtype 6 title "linked cells of 200 x 200 (the paper's)", \
     of("linked_tuned_ms") with linespoints pointtype 4 title "linked cells of one diameter"
