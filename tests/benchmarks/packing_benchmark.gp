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
plot for [i=1:words(solids)] curves index word(solids, i) using 1:2 with linespoints lt i dt i>8?2:1 \
  pt (i > 8 ? 6 : 7) ps 0.8 title word(solids, i) noenhanced
