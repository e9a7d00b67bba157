# Time against true error at the eight operating points of orbit_benchmark.
# usage: gnuplot -c work_precision.gnuplot work_precision.csv work_precision.svg
set terminal svg size 1200,640 dynamic font "sans,11" background "white"
set output ARG2
set datafile separator ","
set logscale xy
set format x "10^{%T}"
set xrange [1e-8:2e-3]
set yrange [20:500000]
set grid lc rgb "#dddddd"
places = "20 37.5 '67.5 up' '67.5 down' 72.5 80 100 140"
methods = "shooting 'event-exact march' 'CVODE Adams' 'CVODE BDF' RK4 'odeint dopri5'"
set multiplot layout 2,4
do for [p = 1:8] {
  place = word(places, p)
  set title place." km/h"
  set key off
  if (p == 4) { set key outside right top }
  set xlabel (p > 4 ? "true error" : "")
  set ylabel (p == 1 || p == 5 ? "time [us]" : "")
  plot for [m = 1:6] ARG1 using (strcol(1) eq place && strcol(2) eq word(methods, m) ? \
    ($6 > 1e-8 ? $6 : 1e-8) : NaN):5 with points pt m ps 0.8 title word(methods, m)
}
unset multiplot
