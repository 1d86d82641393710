# gnuplot -e "curves='FILE'; output='FILE.png'" tests/benchmarks/packing_benchmark.gp
set terminal pngcairo size 900,600 font "sans,11"
set output output
set logscale xy
set xlabel "spheres"
set ylabel "empty, % of the solid"
set format x "%g"
set format y "%g"
set yrange [5:45]
set ytics (5, 7, 10, 15, 20, 30, 40)
set grid
set key outside right
stats curves nooutput
plot for [i=0:STATS_blocks-1] curves index i using 1:2 with linespoints pt 7 ps 0.6 lt i+1 title columnheader(1)
