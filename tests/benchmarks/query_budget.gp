# gnuplot -e "points='FILE'; output='FILE.png'" tests/benchmarks/query_budget.gp
# Error over time, a curve for each depth of the overlap; a panel for each backend that was measured.
cuda = system("awk '$6 > 0' '".points."' | wc -l") > 0
depths = "0-1 1-5 5-15 15-100"
colours = "#7f8c8d #2980b9 #27ae60 #c0392b"
curve(depth, estimator) = "< awk '$1 == ".(depth - 1)." && $2 == \"".estimator."\"' '".points."'"
set terminal pngcairo noenhanced size (cuda ? 1700 : 1100),640 font "sans,13" lw 1.5
set output output
set logscale xy
set grid back lc rgb "#dddddd"
set format y "%g"
set yrange [0.02:120]
set ylabel "mean |error| of the overlap volume, %"
set xlabel "median time of a query (volume and wrench), us"
label(n) = n >= 1024 ? sprintf("%dk", n / 1024) : sprintf("%d", n)
set multiplot layout 1,(cuda ? 2 : 1)
do for [panel=5:(cuda ? 6 : 5)] {
  set title panel == 5 ? "CPU, one core" : "CUDA, one pair at a time, as the host sees it"
  set xrange [panel == 5 ? 4 : 10:panel == 5 ? 4000 : 50]
  set xtics (5, 10, 15, 20, 30, 50, 100, 200, 500, 1000, 2000)
  if (panel == 5 && cuda) { unset key } else { set key outside right top Left reverse samplen 2 }
  plot for [d=1:4] curve(d, "raw") using panel:4 with linespoints pt 6 dt 2 lc rgb word(colours, d) \
      title "plain, ".word(depths, d)." % shared", \
    for [d=1:4] curve(d, "volume-true") using panel:4 with linespoints pt 7 lw 2 lc rgb word(colours, d) \
      title "volume-true, ".word(depths, d)." %", \
    curve(4, "volume-true") using panel:4:(label($3)) with labels offset 0,-1 font ",10" notitle
}
unset multiplot
