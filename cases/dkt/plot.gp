# Heights and falling speeds of the two discs for every combination of form, area and solve, with the reference points; an
# impact and falling speeds by the three contact laws; and frames of one run. Usage: gnuplot -c cases/dkt/plot.gp DIR; DIR holds the runs of the file `runs` (see cases/reproduce).
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

set terminal pngcairo size 1100, 520 font "sans,10"
set output ARG1 . "/laws.png"
laws = "overlap hertz linear"
hue(k) = (k == 1) ? 0xf0b090 : (k == 2) ? 0x2170be : 0x202020
width(k) = (k == 1) ? 5 : (k == 2) ? 2.2 : 1.4
dash(k) = (k == 3) ? 2 : 1
impact(k, which) = ARG1 . "/impact-" . word(laws, k) . which . "/particles.csv"
fall(k, offset) = ARG1 . "/" . ((k == 1) ? "unified-lens-implicit" : "law-" . word(laws, k)) . "-" . offset . "/particles.csv"
push(k) = "law " . word(laws, k)
set multiplot
set origin 0, 0
set size 0.46, 1
set title "one impact at 0.0027 cells/step, without fluid"
set xlabel "steps since the first touch"
set ylabel "contact force / (10^{-3} {/Symbol r} cells^3/step^2)"
set xrange [-10:140]
set yrange [0:15]
set key top right samplen 3
set label 1 "without damping" at 62, 14.1 center
set label 2 "damping 0.34" at 42, 2.6 center
# The force of a step is the mean over this step.
plot for [k=1:3] impact(k, "") using (column("step") - 10.5):(ours(1, 1e3 * column("contact_fx"))) with lines linecolor rgb hue(k) linewidth width(k) dashtype dash(k) title push(k), \
     for [k=1:3] impact(k, "-undamped") using (column("step") - 10.5):(ours(1, 1e3 * column("contact_fx"))) with lines linecolor rgb hue(k) linewidth width(k) dashtype dash(k) notitle
unset label 1
unset label 2
set xrange [0:5]
set yrange [*:*]
set xlabel "t / s"
set ylabel "vertical velocity / (cm/s)"
do for [n=1:2] {
  offset = word("3 0.1", n)
  set origin 0.46, (n == 1) ? 0.5 : 0
  set size 0.54, 0.5
  set title "drafting, kissing, tumbling: start " . offset . " cells apart across gravity"
  set key bottom right samplen 3
  plot for [k=1:3] fall(k, offset) using (column("step") * dt):(ours(0, column("vy") * dx / dt)) with lines linecolor rgb hue(k) linewidth width(k) dashtype dash(k) notitle, \
       for [k=1:3] fall(k, offset) using (column("step") * dt):(ours(1, column("vy") * dx / dt)) with lines linecolor rgb hue(k) linewidth width(k) dashtype dash(k) notitle, \
       reference using 4:((n == 1) ? theirs("uy", "trailing") : NaN) with points pointtype 7 linecolor rgb "black" title ((n == 1) ? "trailing, published" : ""), \
       reference using 4:((n == 1) ? theirs("uy", "leading") : NaN) with points pointtype 6 linecolor rgb "black" title ((n == 1) ? "leading, published" : "")
}
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
