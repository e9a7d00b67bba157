# Error against work of drive cycles, draws and campaigns: user_waits_benchmark.
# usage: gnuplot -c user_waits.gnuplot user_waits.csv user_waits.svg
set terminal svg size 1200,420 dynamic font "sans,11" background "white"
set output ARG2
set datafile separator ","
set grid lc rgb "#dddddd"
rows(name) = "< grep '".name."' ".ARG1
set multiplot layout 1,3

set logscale xy
set format "10^{%T}"
set offsets graph 0.05, graph 0.05, graph 0.05, graph 0.05
set title "Loss of a drive cycle"
set xlabel "processor time [s]"
set ylabel "true error"
set key left bottom
plot for [name in "NEDC 'restless trace'"] rows(name." by map") using 5:6 \
       with linespoints pt 6 title name." by map", \
     for [name in "NEDC 'restless trace'"] rows(name." point by point") using 5:6 \
       with points pt 7 ps 1.2 title name." point by point"

set title "Campaign, by tolerance"
set xlabel "processor time of a point [s]"
set key right top
plot rows("^campaign") using 5:8 with linespoints pt 7 title "largest", \
     rows("^campaign") using 5:6 with linespoints pt 6 title "median", \
     rows("^campaign") using 5:8:(sprintf("%g", $3)) with labels left offset 1,0.5 notitle

set title "95 % interval of a loss"
set xlabel "draws"
set ylabel "width over that of 20,000 draws"
unset logscale y
set format y "%g"
plot rows("^draws") using 4:6:7:8 with yerrorbars pt 7 title "median, least and largest of seeds", \
     1 with lines lc "black" dt 2 notitle
unset multiplot
