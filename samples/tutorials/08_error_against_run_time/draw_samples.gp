# SPDX-License-Identifier: MIT
# Draws what error_against_samples has measured: gnuplot -e "folder = 'FOLDER'" draw_samples.gp
set terminal pngcairo size 960,420 font "sans,12"
set output folder."/08_error_against_samples.png"
set datafile separator ","
set datafile missing NaN
set logscale xy
set format y "%g %%"
set grid linetype 1 linecolor rgb "#dddddd"
set border 3
set tics nomirror
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
