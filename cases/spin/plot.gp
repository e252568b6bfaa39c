# Lift and drag against spin, and against the size of the box. Usage: gnuplot -c cases/spin/plot.gp DIR; DIR holds the runs.
if (ARGC != 1) { print "usage: gnuplot -c cases/spin/plot.gp DIR"; exit status 2 }
reference = system("dirname '" . ARG0 . "'") . "/reference.csv"
figures = ARG1 . "/figures.txt"
ours(key) = sprintf("< awk '$1 ~ /^spin-/ && $2 == \"body.%s\" {print substr($1, 6), $3}' '%s' | sort -n", key, figures)
box(key) = sprintf("< awk '$1 ~ /^box-/ && $2 == \"body.%s\" {print 1 / substr($1, 5), $3} $1 == \"spin-1\" && $2 == \"body.%s\" {print 1 / 200, $3}' '%s' | sort -n", key, key, figures)
theirs(column, who) = sprintf("< awk -F, '!/^#/ && $%d != \"\" && $5 ~ /%s/ {print $1, $%d}' '%s'", column, who, column, reference)
set terminal pngcairo size 1000, 760 font "sans,10"
set output ARG1 . "/spin.png"
set multiplot layout 2, 2
set grid
set xlabel "spin = omega R/U"
set xrange [-0.05:2.1]
set key top left
set title "Fig. 9: lift, Re 20"
set ylabel "C_L"
plot theirs(3, "independent") with lines linewidth 2 linecolor rgb "#2170be" title "independent computation", \
     theirs(3, "Ingham") with points pointtype 4 linecolor rgb "black" title "Ingham and Tang 1990", \
     theirs(3, "Badr") with points pointtype 8 linecolor rgb "black" title "Badr et al. 1989", \
     theirs(3, "Chung") with points pointtype 2 linecolor rgb "black" title "Chung 2006", \
     ours("lift") using 1:(-column(2)) with points pointtype 7 pointsize 1.2 linecolor rgb "#c2481a" title "this program, 200 R"
set title "Fig. 9: drag, Re 20"
set ylabel "C_D"
set key bottom left
plot theirs(2, "independent") with lines linewidth 2 linecolor rgb "#2170be" title "independent computation", \
     theirs(2, "Ingham") with points pointtype 4 linecolor rgb "black" title "Ingham and Tang 1990", \
     theirs(2, "Badr") with points pointtype 8 linecolor rgb "black" title "Badr et al. 1989", \
     theirs(2, "Chung") with points pointtype 2 linecolor rgb "black" title "Chung 2006", \
     theirs(2, "Stojkovic") with points pointtype 6 linecolor rgb "black" title "Stojkovic et al. 2002", \
     ours("drag") with points pointtype 7 pointsize 1.2 linecolor rgb "#c2481a" title "this program, 200 R"
set xlabel "R/L"
set xrange [0:0.027]
set key top left
set title "size of the box, spin 1: lift"
set ylabel "C_L"
plot box("lift") using 1:(-column(2)) with linespoints pointtype 7 linecolor rgb "#c2481a" title "this program", \
     2.7316 with lines linecolor rgb "#2170be" title "unbounded"
set title "size of the box, spin 1: drag"
set ylabel "C_D"
plot box("drag") with linespoints pointtype 7 linecolor rgb "#c2481a" title "this program", \
     1.8192 with lines linecolor rgb "#2170be" title "unbounded"
unset multiplot
