# Snapshots, interface, profiles, mixing. Usage: gnuplot -c cases/settling/plot.gp DIR; DIR holds the runs of `runs`.
if (ARGC != 1) { print "usage: gnuplot -c cases/settling/plot.gp DIR"; exit status 2 }
on = ARG1 . "/on/"
off = ARG1 . "/off/"
figure(key) = system(sprintf("awk '$1 == \"on\" && $2 == \"settling.%s\" {print $3}' '%s/figures.txt'", key, ARG1)) + 0
set datafile separator ","

# Frames of the run: the field of the fluid's speed, one scale for all, and discs by their height at step 0.
set terminal pngcairo size 820, 860 font "sans,10"
set output ARG1 . "/snapshots.png"
set multiplot layout 2, 2 title "Fig. 12: discs by initial height on the fluid's speed, 0 to 0.08 cells/step"
set size ratio -1
unset tics
unset border
do for [step in "0 20000 40000 80000"] {
  set title "step " . step
  plot sprintf("%s/frames/%08d.png", on, step + 0) binary filetype=png with rgbimage notitle
}
unset multiplot

reset
set datafile separator ","
set terminal pngcairo size 1000, 1290 font "sans,10"
set output ARG1 . "/settling.png"
set multiplot layout 3, 2
set grid
set key top right
set title "Fig. 13: interface and sediment"
set xlabel "step / 1000"
set ylabel "height / cells"
u = figure("interface_speed") * 1000
s = figure("front_speed_kynch") * 1000
set fit quiet logfile "/dev/null"
h0 = 1000; s0 = 1
top(x) = h0 - u * x
low(x) = s0 + s * x
fit [15:45] top(x) on . "settling.csv" using (column("step") / 1000):(column("interface")) via h0
fit [15:45] low(x) on . "settling.csv" using (column("step") / 1000):(column("front")) via s0
set xrange [0:80]
set yrange [0:1000]
plot on . "settling.csv" using (column("step") / 1000):(column("interface")) with points pointtype 6 pointsize 0.6 title "interface", \
     top(x) with lines linewidth 2 title sprintf("line of the fit: %.4g cells/step", -u / 1000), \
     on . "settling.csv" using (column("step") / 1000):(column("front")) with points pointtype 4 pointsize 0.6 title "surface of the sediment", \
     low(x) with lines linewidth 2 title sprintf("rise of a single jump (Kynch): %.4g", s / 1000)
set arrow 1 from pi / 4, 0 to pi / 4, 1000 nohead dashtype 2
set title "Fig. 14: concentration"
set xlabel "concentration"
set ylabel "height / cells"
set xrange [0:1]
plot for [step in "0 10000 20000 30000 40000 50000 60000 80000"] on . "profile.csv" \
       using (column("step") == step + 0 ? column("concentration") : NaN):(column("height")) with linespoints pointtype 7 pointsize 0.3 title "step " . step
unset arrow 1
set title "Fig. 15: mixing index (25)"
set xlabel "height / cells"
set ylabel "mean of l\\_0/N\\_l over the discs of layer l"
set xrange [0:1000]
set yrange [0:1]
set key bottom right
plot for [step in "0 10000 20000 30000 40000 60000 80000"] on . "profile.csv" \
       using (column("step") == step + 0 ? column("height") : NaN):(column("lambda")) with linespoints pointtype 7 pointsize 0.3 title "step " . step
set title "Lacey's mixing index of five bands by initial height"
set xlabel "step / 1000"
set ylabel "mixing index"
set xrange [0:80]
set yrange [0:1]
plot on . "settling.csv" using (column("step") / 1000):(column("mixing")) with lines linewidth 2 notitle
set title "Mean height with and without zero\\_flux"
set ylabel "mean height / cells"
set xrange [0:20]
set yrange [*:*]
mean(x) = (column("layer1") + column("layer2") + column("layer3") + column("layer4") + column("layer5")) / 5
plot on . "settling.csv" using (column("step") / 1000):(mean(0)) with lines linewidth 2 title "on", \
     off . "settling.csv" using (column("step") / 1000):(mean(0)) with lines linewidth 2 title "off: the box rings"
unset multiplot
