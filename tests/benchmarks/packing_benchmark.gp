# gnuplot -e "curves='FILE'; output='FILE.png'; solids='box bunny_7k'" tests/benchmarks/packing_benchmark.gp
set terminal pngcairo size 900,560 font "sans,11"
set output output
set logscale xy
set xlabel "spheres"
set ylabel "empty, % of the solid"
set format x "%g"
set format y "%g"
set xrange [900:70000]
set yrange [5:60]
set ytics (5, 7, 10, 15, 20, 30, 40)
set grid
set key outside right
plot for [solid in solids] curves index solid using 1:2 with linespoints pt 7 ps 0.7 title solid noenhanced
