# Overlap areas. Usage: gnuplot -c cases/overlap/plot.gp DIR; reads DIR/bench.txt, writes DIR/overlap.png.
if (ARGC != 1) { print "usage: gnuplot -c cases/overlap/plot.gp DIR"; exit status 2 }
reference = system("dirname '" . ARG0 . "'") . "/reference.csv"
table = ARG1 . "/bench.txt"
set terminal pngcairo size 1000, 460 font "sans,11"
set output ARG1 . "/overlap.png"
set multiplot layout 1, 2
set grid
f(beta) = 4 * sqrt(2) / (3 * pi) * (1 + beta ** 2) / (1 + beta) ** 2
set key top left
set xlabel "delta*"
set ylabel "A*"
set title "Fig. 2: overlap area by ratio of radii"
ratios = "1 1.5 2 3 5 10"
plot for [b=1:6] table index 0 using 1:(column(b + 1)) skip 3 with points pointtype 6 linecolor b title "beta " . word(ratios, b), \
     for [b=1:6] [x=0:1] f(word(ratios, b) + 0) * x ** 1.5 with lines linecolor b notitle
set xlabel "overlap / cells"
set ylabel "area / cells^2"
set title "Fig. 5: area by cells and closed form, R = 10"
plot table index 2 using 1:3:4 skip 2 with yerrorbars pointtype 7 pointsize 0.5 title "by cells (23)-(24), with spread over places", \
     table index 2 using 1:2 skip 2 with lines linewidth 2 title "closed form"
unset multiplot
