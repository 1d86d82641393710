# gnuplot -e "points='FILE'; output='FILE.png'" tests/benchmarks/query_growth.gp
set terminal pngcairo noenhanced size 900,640 font "sans,13" lw 1.5
set output output
set logscale xy
set grid back lc rgb "#dddddd"
set key top left Left reverse samplen 2
set title "Two interlocked Chazelle polyhedra, one core"
set xlabel "triangles of each body"
set ylabel "time of a query, us"
stats points using 1:2 nooutput name "p"
stats points using ($0 == 0 ? $1 : NaN):($0 == 0 ? $2 : NaN) nooutput name "first"
square(x) = first_min_y * (x / first_min_x)**2
linear(x) = first_min_y * (x / first_min_x)
set yrange [30:2e5]
set xrange [p_min_x * 0.9:p_max_x * 1.1]
set xtics (30, 60, 100, 200, 400, 800, 1600, 3200)
plot points using 1:2 with linespoints pt 7 lw 2 lc rgb "#c0392b" title "triangles: Bullet's GImpact, all contacts", \
  points using 1:3 with linespoints pt 5 lw 2 lc rgb "#e67e22" title "triangles: FCL, all contacts", \
  points using 1:5 with linespoints pt 9 lw 2 lc rgb "#2980b9" title "spheres in proportion to the triangles", \
  points using 1:4 with linespoints pt 11 lw 2 lc rgb "#27ae60" title "always the same number of spheres", \
  square(x) with lines dt 2 lc rgb "#999999" title "quadratic", linear(x) with lines dt 3 lc rgb "#999999" title "linear"
