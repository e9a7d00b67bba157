# Error over estimate, and time, of the wild scenes of population_benchmark; a column of panels for
# each tolerance.
# usage: gnuplot -c population.gnuplot population.csv population.png
set terminal pngcairo size 1200,640 font "sans,9"
set output ARG2
set datafile separator ","
column_values(n) = system("tail -n +2 '".ARG1."' | cut -d, -f".n." | tr -d '\"' | sort -gr | uniq | \
  sed \"s/.*/'&'/\" | tr '\\n' ' '")
tolerances = column_values(3)
methods = column_values(7)
is(t, m) = strcol(3) eq t && strcol(7) eq m
set logscale y
set format y "10^{%T}"
set xtics 500
set grid lc rgb "#dddddd"
set multiplot layout 2,words(tolerances) margins 0.06,0.98,0.12,0.95 spacing 0.05,0.12
do for [row = 1:2] {
  do for [t in tolerances] {
    set title "tolerance ".t
    set xlabel (row == 2 ? "scene" : "")
    set ylabel (t eq word(tolerances, 1) ? (row == 1 ? "true error / estimate" : "time [s]") : "")
    if (row == 1 && t eq word(tolerances, 1)) {
      set key horizontal center at screen 0.5,0.03
    } else {
      set key off
    }
    limit = row == 1 ? 1 : 0.5
    plot for [m = 1:words(methods)] ARG1 using \
           (is(t, word(methods, m)) ? $1 : NaN):(row == 1 ? $4 / $5 : 1e-6 * $6) \
           with points lt m pt 7 ps 0.25 notitle, \
         limit with lines lc "black" lw 1.5 notitle, \
         for [m = 1:words(methods)] keyentry with points lt m pt 7 title word(methods, m)
  }
}
unset multiplot
