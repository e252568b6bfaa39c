# Heights and falling speeds of the two discs for every combination of form, area and solve, with the reference points; the
# contact laws; and frames of one run. Usage: gnuplot -c cases/dkt/plot.gp DIR; DIR holds the runs of the file `runs` (see cases/reproduce).
if (ARGC != 1) { print "usage: gnuplot -c cases/dkt/plot.gp DIR   (DIR: the runs)"; exit status 2 }
reference = system("dirname '" . ARG0 . "'") . "/reference.csv"

# One lattice unit in centimetres and seconds.
dx = 0.01
dt = 5e-4

set datafile separator ","
set datafile missing NaN # rows of the other disc do not break a line
set terminal pngcairo size 1000, 900 font "sans,10"
set output ARG1 . "/dkt.png"

# Rows of particles.csv that belong to one disc; points of reference.csv of one quantity and disc.
ours(id, value) = column("id") == id ? value : NaN
is(quantity, disc) = strcol(1) eq "point" && strcol(2) eq quantity && strcol(3) eq disc
theirs(quantity, disc) = is(quantity, disc) ? column(5) : NaN

runs = "unified-lens-implicit unified-cells-implicit owen-lens-implicit owen-cells-implicit unified-lens-explicit-averaged unified-cells-explicit-averaged owen-lens-explicit-averaged owen-cells-explicit-averaged"
results(k, offset) = ARG1 . "/" . word(runs, k) . "-" . offset . "/particles.csv"
shade(k) = (k < 3) ? 0xc2481a : (k < 5) ? 0x2170be : (k < 7) ? 0xe8a27f : 0x8ab8de
style(k) = (k % 2) ? 1 : 3 # by cells: thin

set multiplot layout 2, 2
set xrange [0:5]
set xlabel "t / s"
set grid
set key top right samplen 2
do for [offset in "3 0.1"] {
  set title "start " . offset . " cells apart across gravity"
  set ylabel "height y / cm"
  plot for [k=1:8] results(k, offset) using (column("step") * dt):(ours(0, column("y") * dx)) with lines linecolor rgb shade(k) linewidth style(k) notitle, \
       for [k=1:8] results(k, offset) using (column("step") * dt):(ours(1, column("y") * dx)) with lines linecolor rgb shade(k) linewidth style(k) dashtype 2 \
         title (k == 1 ? "unified, implicit" : k == 3 ? "owen, implicit" : k == 5 ? "unified, explicit" : k == 7 ? "owen, explicit" : ""), \
       reference using 4:(theirs("y", "trailing")) with points pointtype 7 linecolor rgb "black" title "trailing, published", \
       reference using 4:(theirs("y", "leading")) with points pointtype 6 linecolor rgb "black" title "leading, published"
  set ylabel "vertical velocity / (cm/s)"
  plot for [k=1:8] results(k, offset) using (column("step") * dt):(ours(0, column("vy") * dx / dt)) with lines linecolor rgb shade(k) linewidth style(k) notitle, \
       for [k=1:8] results(k, offset) using (column("step") * dt):(ours(1, column("vy") * dx / dt)) with lines linecolor rgb shade(k) linewidth style(k) dashtype 2 notitle, \
       reference using 4:(theirs("uy", "trailing")) with points pointtype 7 linecolor rgb "black" notitle, \
       reference using 4:(theirs("uy", "leading")) with points pointtype 6 linecolor rgb "black" notitle
}
unset multiplot

set terminal pngcairo size 1000, 420 font "sans,10"
set output ARG1 . "/laws.png"
laws = "overlap hertz linear"
hue(k) = (k == 1) ? 0xc2481a : (k == 2) ? 0x2170be : 0x2f8f4e
set multiplot layout 1, 2
set title "one impact without fluid"
set xlabel "time / steps"
set ylabel "impulse a step / lattice units"
set xrange [80:200]
plot for [k=1:3] ARG1 . "/impact-" . word(laws, k) . "/particles.csv" using "step":(ours(1, column("contact_fx"))) with lines \
  linewidth 4 - k linecolor rgb hue(k) dashtype k title word(laws, k)
set title "the same laws in this case, from 3 cells"
set xlabel "t / s"
set ylabel "vertical velocity / (cm/s)"
set xrange [0:5]
set key bottom right
plot for [k=1:3] ARG1 . "/law-" . word(laws, k) . "-3/particles.csv" using (column("step") * dt):(ours(0, column("vy") * dx / dt)) with lines \
       linewidth 4 - k linecolor rgb hue(k) dashtype k title "trailing, " . word(laws, k), \
     for [k=1:3] ARG1 . "/law-" . word(laws, k) . "-3/particles.csv" using (column("step") * dt):(ours(1, column("vy") * dx / dt)) with lines \
       linewidth 2 linecolor rgb hue(k) dashtype k title "leading, " . word(laws, k)
unset multiplot

reset
set terminal pngcairo size 900, 640 font "sans,10"
set output ARG1 . "/frames.png"
set multiplot layout 1, 5
unset tics
unset border
set size ratio -1
do for [step in "1500 2500 3250 3750 5000"] {
  set title sprintf("%.2f s", step * dt)
  plot sprintf("%s/pictures-3/frames/%08d.png", ARG1, step + 0) binary filetype=png with rgbimage notitle
}
unset multiplot
