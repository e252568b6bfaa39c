# Run-out of columns. Usage: gnuplot -c cases/column/plot.gp DIR; reads DIR/figures.txt, writes DIR/column.png.
if (ARGC != 1) { print "usage: gnuplot -c cases/column/plot.gp DIR"; exit status 2 }
of(name) = sprintf("< awk '$1 == \"%s\" && sub(/^aspect-/, \"\", $2) {print $2, $3}' '%s/figures.txt'", name, ARG1)
set terminal pngcairo size 720, 520 font "sans,11"
set output ARG1 . "/column.png"
set grid
set logscale xy
set key top left
set xlabel "H_0/x_0"
set ylabel "(x - x_0)/x_0"
set title "Run-out of columns of 1000 dry discs"
law(a) = a < 2 ? 2.5 * a : 3.25 * a ** 0.7
plot [0.4:15] law(x) with lines linewidth 2 linecolor "gray" title "Staron and Hinch 2005: 2.5 a, 3.25 a^{0.7}", \
     of("friction_0.5") with points pointtype 7 linecolor 1 title "friction 0.5", \
     of("friction_1") with points pointtype 6 linecolor 2 title "friction 1", \
     of("friction_0.5_rough") with points pointtype 4 linecolor 3 title "friction 0.5, rough ground"
