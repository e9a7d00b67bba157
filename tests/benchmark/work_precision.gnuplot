# Time against true error at the eight operating points of orbit_benchmark.
# usage: gnuplot -c work_precision.gnuplot work_precision.csv work_precision.svg
set terminal svg size 1200,960 dynamic font "sans,11" background "white"
set output ARG2
set datafile separator ","
least_error = 1e-9 # less is drawn here
error(x) = x > least_error ? x : least_error
stats ARG1 using (error($6)):5 skip 1 nooutput
set logscale xy
set format "10^{%T}"
set xrange [0.5 * STATS_min_x : 2 * STATS_max_x]
set yrange [0.5 * STATS_min_y : 2 * STATS_max_y]
set grid lc rgb "#dddddd"
places = "20 37.5 '67.5 up' '67.5 down' 72.5 80 100 140"
methods = "shooting 'Gauss collocation' 'Gauss collocation unaided' 'CVODE shooting' \
'CVODE Adams' 'CVODE BDF' RK4 'odeint dopri5' 'event-exact march'"
colours = "black #d95f02 #d95f02 #e7298a #1f78b4 #33a02c #a6761d #7570b3 #999999"
shapes = "5 6 7 2 4 10 8 12 3"
name(m) = m == 1 ? "this solver" : word(methods, m)
set multiplot layout 3,3
set key off
do for [p = 1:8] {
  place = word(places, p)
  set title place." km/h"
  set xlabel (p > 5 ? "true error" : "")
  set ylabel (p % 3 == 1 ? "time [us]" : "")
  plot for [m = 1:9] ARG1 using \
    (strcol(1) eq place && strcol(2) eq word(methods, m) ? error($6) : NaN):5 \
    with linespoints pt int(word(shapes, m)) ps 0.6 lc rgb word(colours, m) title name(m)
}
# The key has the ninth cell.
unset title
unset xlabel
unset ylabel
unset tics
unset border
unset grid
set key center spacing 1.3
plot for [m = 1:9] NaN with linespoints pt int(word(shapes, m)) ps 0.6 lc rgb word(colours, m) title name(m)
unset multiplot
