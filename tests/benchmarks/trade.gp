# gnuplot -e "table='FILE.csv'; picture='scenes'; output='FILE.png'" tests/benchmarks/trade.gp
# Pictures of the table that trade_measure writes: scenes, rates, volume, direction, pressure.
# Columns: 1 scene, 2 measure, 3 way, 4 pieces, 5 response, 6 estimator, 7 backend, 8 rate, 9 value, 10 error, 11 unit,
# 12 processor time.
set datafile separator ","
rows(condition) = "< awk -F, '!/^#/ && ".condition."' '".table."'"
# Sorted by pieces, so that lines run from few to many.
along(condition) = "< awk -F, '!/^#/ && ".condition."' '".table."' | sort -t, -k4,4n -k8,8n"
have(condition) = system("awk -F, '!/^#/ && ".condition."' '".table."' | wc -l") > 0
label(n) = n >= 1024 ? sprintf("%dk", int(n / 1024)) : sprintf("%d", n)
within(x) = x < 1.2e-3 ? 1.2e-3 : x > 100 ? 100 : x  # what is out of range is drawn near the edge

packing = "#c0392b"; rigid = "#8e44ad"; penalty = "#e67e22"; gimpact = "#2980b9"; spheres = "#7f8c8d"; convex = "#27ae60"
set terminal pngcairo noenhanced size 1200,790 font "sans,11" lw 1.5
set output output
set logscale xy
set grid back lc rgb "#dddddd"
set format "%g"
set key top right samplen 2 opaque Left reverse font ",9"
set tics font ",10"

if (picture eq "scenes") {
  names = "chain-hang bowls stack"
  titles = '"Chain of ten rings: its length" "Five bowls in each other: worst height" "Stack of ten boxes: height, % of a box"'
  set multiplot layout 2,2 title "Error over processor time, one core" font ",14"
  do for [i=1:3] {
    is = '$1 == "'.word(names, i).'" && ($2 == "worst" || $2 == "trajectory") && $7 == "cpu" && $8 == 240'
    if (!have(is)) { continue }
    set title word(titles, i)
    set ylabel "error, %"
    set xlabel "processor time of a step at 240 steps/s, ms"
    if (i == 3) { set key bottom right } else { unset key }
    set yrange [5e-4:300]
    set xrange [0.02:20]
    # Points of kept contacts lie on each other: only the fewest and the most spheres have labels.
    few = system("awk -F, '".is." && $3 == \"packing\" { print $4 }' '".table."' | sort -n | head -n 1") + 0
    most = system("awk -F, '".is." && $3 == \"packing\" { print $4 }' '".table."' | sort -n | tail -n 1") + 0
    below = i == 1 ? -0.9 : 0.9
    plot along(is.' && $3 == "packing" && $5 == "compliant"') using ($12/1e3):(within($10)) with linespoints pt 7 lw 2 lc rgb packing title "packing, compliant", \
      "" using ($12/1e3):($4 == few ? within($10) : NaN):(label($4)) with labels offset 0.6,below font ",9" tc rgb packing notitle, \
      "" using ($12/1e3):($4 == most ? within($10) : NaN):(label($4)) with labels offset -0.6,0.9 font ",9" tc rgb packing notitle, \
      along(is.' && $3 == "packing" && $5 == "rigid"') using ($12/1e3):(within($10)) with linespoints pt 5 lc rgb rigid title "packing, rigid", \
      along(is.' && $3 == "packing" && $5 == "penalty"') using ($12/1e3):(within($10)) with linespoints pt 9 lc rgb penalty title "packing, penalty", \
      rows(is.' && $3 == "gimpact"') using ($12/1e3):(within($10)) with points pt 13 ps 2.2 lc rgb gimpact title "GImpact mesh", \
      "" using ($12/1e3):(within($10)):(sprintf("%d tri", $4)) with labels offset 0,-1.1 font ",9" tc rgb gimpact notitle, \
      along(is.' && $3 == "spheres"') using ($12/1e3):(within($10)) with linespoints pt 6 dt 2 lc rgb spheres title "btCompoundShape of spheres", \
      "" using ($12/1e3):(within($10)):(label($4)) with labels offset 0,-0.9 font ",9" tc rgb spheres notitle, \
      along(is.' && $3 == "convex"') using ($12/1e3):(within($10)) with linespoints pt 4 dt 2 lc rgb convex title "btCompoundShape of hulls", \
      "" using ($12/1e3):(within($10)):(label($4)) with labels offset 0,-0.9 font ",9" tc rgb convex notitle
  }
  is = '$1 == "overlap-torus" && $2 == "volume" && $7 == "cpu"'
  if (have(is)) {
    set title "Two tori that share 2 %: overlap volume"
    set xlabel "time of a query, us"
    set ylabel "mean |error|, %"
    set xrange [1:1000]
    set yrange [0.1:100]
    set key top right
    plot along(is.' && $6 == "volume-true"') using 12:10 with linespoints pt 7 lw 2 lc rgb packing title "packing, volume-true radii", \
      "" using 12:10:(label($4)) with labels offset 0,0.9 font ",9" tc rgb packing notitle, \
      along(is.' && $6 == "raw"') using 12:10 with linespoints pt 6 dt 2 lc rgb penalty title "packing, as packed (the paper)"
  }
  unset multiplot
}

if (picture eq "rates") {
  names = "chain-hang chain-swing chain-heavy stack"
  titles = '"Chain of ten rings: its length" "Swinging chain, 1 s: distance from a fine run" "The same chain, last ring 100 times as heavy: its length" "Stack of ten boxes: height, % of a box"'
  set multiplot layout 2,2 title "Error over processor time of a simulated second, by steps per second; 1,024 spheres" font ",14"
  do for [i=1:4] {
    is = '$1 == "'.word(names, i).'" && ($2 == "worst" || $2 == "trajectory") && $7 == "cpu"'
    if (!have(is)) { continue }
    set title word(titles, i)
    set ylabel "error, %"
    set xlabel "processor time of a simulated second, ms"
    if (i == 1) { set key top right } else { unset key }
    set yrange [5e-4:300]
    x(us, rate) = us * rate / 1e3
    plot along(is.' && $3 == "packing" && $5 == "compliant" && $4 == 1024') using (x($12, $8)):(within($10)) with linespoints pt 7 lw 2 lc rgb packing title "packing, compliant", \
      "" using (x($12, $8)):($8 == 60 ? within($10) : NaN):(sprintf("%d", $8)) with labels offset 0,0.9 font ",9" tc rgb packing notitle, \
      "" using (x($12, $8)):($8 == 60 ? NaN : within($10)):(sprintf("%d", $8)) with labels left offset 0.9,0 font ",9" tc rgb packing notitle, \
      along(is.' && $3 == "packing" && $5 == "rigid" && $4 == 1024') using (x($12, $8)):(within($10)) with linespoints pt 5 lc rgb rigid title "packing, rigid", \
      "" using (x($12, $8)):(within($10)):(sprintf("%d", $8)) with labels right offset -0.9,0 font ",9" tc rgb rigid notitle, \
      along(is.' && $3 == "gimpact"') using (x($12, $8)):(within($10)) with linespoints pt 13 ps 1.5 lc rgb gimpact title "GImpact mesh", \
      "" using (x($12, $8)):(within($10)):(sprintf("%d", $8)) with labels offset 0,0.9 font ",9" tc rgb gimpact notitle, \
      along(is.' && $3 == "spheres" && $4 == 256') using (x($12, $8)):(within($10)) with linespoints pt 6 dt 2 lc rgb spheres title "btCompoundShape of 256 spheres", \
      "" using (x($12, $8)):(within($10)):(sprintf("%d", $8)) with labels right offset -0.3,0.7 font ",9" tc rgb spheres notitle
  }
  unset multiplot
}

if (picture eq "volume" || picture eq "direction") {
  names = system("awk -F, '$1 ~ /^overlap-/ && $1 != \"overlap-ball\" && !seen[$1]++ { print $1 }' '".table."' | tr '\\n' ' '")
  set multiplot layout 2,(words(names) + 1) / 2 title picture eq "volume" ? "Error of the overlap volume over the time of a query, where 2 % of a solid is shared" : "Error of the direction of the push over the time of collision detection, where 2 % of a solid is shared" font ",14"
  do for [i=1:words(names)] {
    is = '$1 == "'.word(names, i).'" && $2 == "'.picture.'" && $7 == "cpu"'
    onCuda = '$1 == "'.word(names, i).'" && $2 == "'.picture.'" && $7 == "cuda" && $6 == "volume-true"'
    set title substr(word(names, i), 9, -1)
    set xlabel "time, us"
    set ylabel picture eq "volume" ? "mean |error|, %" : "mean angle, degrees"
    if (i == 1) { set key bottom left } else { unset key }
    if (picture eq "volume") {
      set yrange [0.03:150]
      set xrange [1:1000]
      plot along(is.' && $6 == "volume-true"') using 12:10 with linespoints pt 7 lw 2 lc rgb packing title "packing, volume-true radii", \
        "" using 12:10:(label($4)) with labels left offset 0.6,0.4 font ",9" tc rgb packing notitle, \
        along(is.' && $6 == "raw"') using 12:10 with linespoints pt 7 dt 2 lc rgb penalty title "packing, as packed (the paper)", \
        (have(onCuda) ? along(onCuda) : along(is.' && $6 == "none"')) using 12:10 with linespoints pt 7 lc rgb "black" title (have(onCuda) ? "packing, CUDA" : "")
    } else {
      set yrange [0.03:100]
      plot along(is.' && $6 == "volume-true"') using 12:10 with linespoints pt 7 lw 2 lc rgb packing title "packing, gradient of the volume", \
        "" using 12:10:(label($4)) with labels left offset 0.6,0.4 font ",9" tc rgb packing notitle, \
        along(is.' && $6 == "raw"') using 12:10 with linespoints pt 7 dt 2 lc rgb penalty title "packing, force of the paper", \
        rows(is.' && $3 == "gimpact"') using 12:10 with points pt 13 ps 2.2 lc rgb gimpact title "GImpact mesh", \
        along(is.' && $3 == "spheres"') using 12:10 with linespoints pt 6 dt 2 lc rgb spheres title "compound of spheres", \
        along(is.' && $3 == "convex"') using 12:10 with linespoints pt 4 dt 2 lc rgb convex title "compound of hulls"
    }
  }
  unset multiplot
}

if (picture eq "pressure") {
  set terminal pngcairo noenhanced size 1000,500 font "sans,12" lw 1.5
  set output output
  set multiplot layout 1,2 title "How far a body sinks into a plane under a given stiffness: error of the depth" font ",14"
  set xlabel "processor time of a step with both bodies, us"
  set ylabel "error, %"
  do for [body in "box ball"] {
    is = '$1 == "soft" && $2 == "depth of the '.body.'" && $7 == "cpu"'
    set title body
    if (!have(is)) { continue }
    set yrange [0.01:500]
    set xrange [5:500]
    sunk(x) = x > 0.03 ? x : 0.03  # what is more exact is drawn near the edge
    if (body eq "box") { set key top right } else { unset key }
    plot along(is.' && $6 == "volume-true"') using 12:(sunk($10)) with linespoints pt 7 lw 2 lc rgb packing title "volume-true radii", \
      "" using 12:($4 == 256 ? NaN : sunk($10)):(label($4)) with labels offset 0,0.9 font ",9" tc rgb packing notitle, \
      "" using 12:($4 == 256 ? sunk($10) : NaN):(label($4)) with labels offset 0,-0.9 font ",9" tc rgb packing notitle, \
      along(is.' && $6 == "raw"') using 12:(sunk($10)) with linespoints pt 7 dt 2 lc rgb penalty title "as packed (the paper)"
  }
  unset multiplot
}
