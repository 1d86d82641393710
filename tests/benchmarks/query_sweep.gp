# gnuplot -e "points='FILE'; output='FILE.png'" tests/benchmarks/query_sweep.gp
# A row for each backend. Left: time over the angle at 60,000 spheres. Right: median and worst over the number of spheres.
solids = system("grep -v '^#' '".points."' | awk '{print $1}' | sort -u")
backends = system("grep -v '^#' '".points."' | awk '{print $3}' | sort -u")
pick(solid, backend, spheres) = "< awk '$1 == \"".solid."\" && $2 == ".spheres." && $3 == \"".backend."\"' '".points."'"
# spheres, median and worst time of a solid
summary(solid, backend) = "< awk '$1 == \"".solid."\" && $3 == \"".backend."\" {print $2, $5}' '".points."' | sort -n -k1,1 -k2,2 | \
awk 'function row() {if (n) print last, t[int((n + 1) / 2)], t[n]} $1 != last {row(); n = 0; last = $1} {t[++n] = $2} END {row()}'"
set terminal pngcairo noenhanced size 1400,560*words(backends) font "sans,13" lw 1.5
set output output
set grid back lc rgb "#dddddd"
set key outside right top samplen 2
set autoscale yfix
set offsets 0, 0, graph 0.06, graph 0.06
set ytics (5, 7, 10, 15, 20, 30, 50, 70, 100, 150, 200, 300, 500, 700, 1000, 1500, 2000, 3000, 5000, 10000, 20000, 50000)
set multiplot layout words(backends),2
do for [backend in backends] {
  set title backend.", 60,000 spheres of each body: one pose after the other"
  unset logscale
  set logscale y
  set xrange [0:360]
  set xtics 60
  set xlabel "angle of the copy, degrees"
  set ylabel "time of a query, us"
  plot for [i=1:words(solids)] pick(word(solids, i), backend, "60000") using 4:5 with lines lw 2 lc i title word(solids, i)
  set title backend.": median (line) and worst (points) of the poses"
  set logscale xy
  set xrange [3000:1.3e6]
  set xtics ("4k" 4000, "10k" 10000, "20k" 20000, "60k" 60000, "250k" 250000, "1M" 1000000)
  set xlabel "spheres of each body"
  plot for [i=1:words(solids)] summary(word(solids, i), backend) using 1:2 with lines lw 2 lc i title word(solids, i), \
    for [i=1:words(solids)] summary(word(solids, i), backend) using 1:3 with points pt 7 ps 0.9 lc i notitle
}
unset multiplot
