# gnuplot -e "points='FILE'; output='FILE.png'" tests/benchmarks/overlap_accuracy.gp
set terminal pngcairo size 1100,560 font "sans,11"
set output output
set logscale xy
set xrange [0.03:60]
set yrange [0.01:130]
set xlabel "overlap, % of the solid"
set format x "%g"
set format y "%g"
set grid
set key bottom left
set multiplot layout 1,2
set title "plain spheres"
set ylabel "|error| of the overlap volume, %"
plot for [n in "1000 4000 16000"] points using ($2 == n ? 100*$3 : 1/0):(100*abs($4)) \
  with points pt 7 ps 0.5 title n." spheres"
set title "volume-true radii"
plot for [n in "1000 4000 16000"] points using ($2 == n ? 100*$3 : 1/0):(100*abs($5)) \
  with points pt 7 ps 0.5 title n." spheres"
unset multiplot
