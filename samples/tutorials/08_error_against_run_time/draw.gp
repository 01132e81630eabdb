# SPDX-License-Identifier: MIT
# Draws what both programs have measured: gnuplot -e "folder = 'FOLDER'" draw.gp
set datafile separator ","
set datafile missing NaN
set grid linetype 1 linecolor rgb "#dddddd"
set border 3
set tics nomirror

# Error of t against the time of a ray.
set terminal pngcairo size 900,520 font "sans,12"
set output folder."/08_error_against_run_time.png"
measured = folder."/error_against_time.csv"
front = folder."/error_against_time_front.csv"
stats measured using 2:6 nooutput
set xrange [STATS_min_x / 1.4 : STATS_max_x * 1.6]
set yrange [STATS_min_y / 5 : STATS_max_y * 6]
set logscale xy
set xtics (10, 20, 30, 50, 70, 100, 150, 200, 300, 400, 500, 700, 1000, 2000) nomirror
set ytics (0.2, 0.5, 1, 2, 5, 10, 20) nomirror
set key top right
set xlabel "nanoseconds a ray: median of 15 rounds and its 95 % interval"
set ylabel "error of t in units in the last place, 99th percentile"
# Columns: name, ns, both ends of its interval, error of t (median, 99 %, largest), faults, rays aimed.
right(faults) = faults == 0 ? 1 : NaN
wrong(faults) = faults > 0 ? 1 : NaN
plot front using 2:6 with lines linewidth 2 linecolor rgb "#808080" title "the front of those without faults", \
     measured using 2:($6 * right($8)):3:4 with xerrorbars pointtype 7 pointsize 1.4 linewidth 2 \
         linecolor rgb "#2f81f7" title "all aimed rays right", \
     measured using 2:($6 * wrong($8)):3:4 with xerrorbars pointtype 6 pointsize 1.4 linewidth 2 \
         linecolor rgb "#d9730d" title "some wrong: leaks", \
     measured using 2:($6 * right($8)):1 with labels left rotate by -45 offset 1.4,-0.3 notitle, \
     measured using 2:($6 * wrong($8)):1 with labels left rotate by 45 offset 0.6,0.8 notitle

# Error of a view factor against rays, and against time.
set terminal pngcairo size 960,420 font "sans,12"
set output folder."/08_error_against_samples.png"
set xtics autofreq
set ytics autofreq
set autoscale y
set format y "%g %%"
set ylabel "relative error (root mean square)"
measured = folder."/error_against_samples.csv"
names = "'random hits' 'Sobol hits' 'Sobol areas'"
colors = "'#d9730d' '#2f81f7' '#2a9d5c'"
set multiplot layout 1,2
set xrange [200 : 100000]
set key bottom left
set xlabel "rays"
set format x "10^{%L}"
plot for [i = 1:3] measured using (strcol(1) eq word(names, i) ? $2 : NaN):(100 * $3) with linespoints \
         pointtype 7 linewidth 2 linecolor rgb word(colors, i) title word(names, i), \
     200 / sqrt(x) linewidth 2 linecolor rgb "#808080" dashtype 2 title "slope -1/2"
unset key
set autoscale x
set xlabel "milliseconds until the answer"
set format x "%g"
plot for [i = 1:3] measured using (strcol(1) eq word(names, i) ? $4 : NaN):(100 * $3) with linespoints \
         pointtype 7 linewidth 2 linecolor rgb word(colors, i), \
     0.2 linewidth 2 linecolor rgb "#808080" dashtype 3
unset multiplot
