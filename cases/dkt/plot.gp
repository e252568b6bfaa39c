# Heights and falling speeds of the two discs, with the reference points. Usage, from the top of the source:
#   gnuplot -c cases/dkt/plot.gp out/dkt        reads out/dkt/particles.csv, writes out/dkt/dkt.png
if (ARGC != 1) { print "usage: gnuplot -c cases/dkt/plot.gp DIR   (DIR: results of the run)"; exit status 2 }
results = ARG1 . "/particles.csv"
reference = system("dirname '" . ARG0 . "'") . "/reference.csv"

# One lattice unit in centimetres and seconds.
dx = 0.01
dt = 5e-4

set datafile separator ","
set terminal pngcairo size 1000, 520 font "sans,11"
set output ARG1 . "/dkt.png"
set multiplot layout 1, 2
set xrange [0:5]
set xlabel "t / s"
set grid
set key above samplen 2 maxcols 2

# Rows of particles.csv that belong to one disc; points of reference.csv of one quantity and disc.
ours(id, value) = column("id") == id ? value : NaN
is(quantity, disc) = strcol(1) eq "point" && strcol(2) eq quantity && strcol(3) eq disc
theirs(quantity, disc) = is(quantity, disc) ? column(5) : NaN

set style line 1 linecolor rgb "#c2481a" linewidth 2 pointtype 6
set style line 2 linecolor rgb "#2170be" linewidth 2 pointtype 4
set datafile missing NaN # rows of the other disc do not break a line

set ylabel "height y / cm"
plot results using (column("step") * dt):(ours(0, column("y") * dx)) with lines linestyle 1 title "trailing", \
     results using (column("step") * dt):(ours(1, column("y") * dx)) with lines linestyle 2 title "leading", \
     reference using 4:(theirs("y", "trailing")) with points linestyle 1 title "trailing, reference", \
     reference using 4:(theirs("y", "leading")) with points linestyle 2 title "leading, reference"

set ylabel "vertical velocity / (cm/s)"
plot results using (column("step") * dt):(ours(0, column("vy") * dx / dt)) with lines linestyle 1 title "trailing", \
     results using (column("step") * dt):(ours(1, column("vy") * dx / dt)) with lines linestyle 2 title "leading", \
     reference using 4:(theirs("uy", "trailing")) with points linestyle 1 title "trailing, reference", \
     reference using 4:(theirs("uy", "leading")) with points linestyle 2 title "leading, reference"
unset multiplot
