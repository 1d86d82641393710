#!/usr/bin/env bash
# One page, which needs nothing else, from what trade.sh wrote into FOLDER: ./tests/benchmarks/trade_page.sh FOLDER
set -euo pipefail
out=$1

image() { # FILE WIDTH ALTERNATIVE
  printf '<img src="data:image/png;base64,%s" width="%s" alt="%s">\n' "$(base64 -w0 "$out/$1")" "$2" "$3"
}
plot() { # NAME TITLE TEXT
  printf '<h2>%s</h2>\n<p>%s</p>\n' "$2" "$3"
  image "$1.png" 1000 "$2"
}
shape() { # NAME CAPTION
  printf '<figure>'
  image "shape-$1.png" 480 "$2"
  printf '<figcaption>%s</figcaption></figure>\n' "$2"
}

cat <<'HTML'
<!doctype html>
<html lang="en"><head><meta charset="utf-8"><title>InnerSphere: speed against accuracy</title>
<style>
body { font: 16px/1.5 sans-serif; max-width: 1020px; margin: 2em auto; padding: 0 1em; color: #222 }
img { max-width: 100%; height: auto } figure { display: inline-block; margin: 0 10px 10px 0 }
figcaption { font-size: 14px; text-align: center } pre { background: #f4f4f4; padding: .7em; white-space: pre-wrap }
table { border-collapse: collapse; font-size: 13px } td, th { border: 1px solid #ccc; padding: 2px 7px; text-align: right }
</style></head><body>
<h1>Speed against accuracy</h1>
HTML
printf '<pre>'
sed -n 's/^# //p' "$out/trade.csv" | sed 's/&/\&amp;/g; s/</\&lt;/g'
printf '</pre>\n'
cat <<'HTML'
<p>Times are processor times of one core, so that other programs do not add to them; short runs and single overlaps are repeated
in turns, and the least counts. All shapes have the same mass properties and start from the same places; the scenes are those of
<code>innersphere scene run NAME --shape packing|gimpact|spheres|convex</code>. Errors are against closed forms, but for the
swinging chain, where the reference is a run with 4,096 spheres at 1,920 steps a second.</p>
<h2>What collides</h2>
HTML
shape packing "packing: surface, and the spheres that find its contacts"
shape gimpact "gimpact: the triangles of the surface"
shape spheres "spheres: btCompoundShape of the packing's 256 largest"
shape convex "convex: btCompoundShape of hulls of sectors and layers"
plot trade "Scenes, by number of spheres" "Labels: spheres, triangles or hulls of a body. What is more exact than 0.001 % is drawn there; what is off by more than 100 %, as 100 %. Of packings the fewest and the most spheres are labelled. The margin of GImpact is 0.0001 of the size; with 0.001 its chain is sixteen times as far off."
plot trade-rates "Scenes, by time step" "Labels: steps a second. Short steps buy what spheres cannot. At 100 % the stack has fallen or a ring is lost."
plot trade-volume "Volume of single overlaps" "Eight copies of each solid in random places, each with 2 % of its volume inside the solid; volumes are sampled. No other way knows volumes."
plot trade-direction "Direction of the push" "The same copies. The truth is the gradient of the volume, integrated over the surface; of Bullet's own shapes, contacts are summed by their depth."
plot trade-pressure "Depth under a given stiffness" "A box and a ball on a plane, with ContactOptions::stiffness set: here the spheres alone decide."
printf '<h2>All numbers</h2>\n<table>\n'
grep -v '^#' "$out/trade.csv" | awk -F, '{ tag = NR == 1 ? "th" : "td"; printf "<tr>"; for (i = 1; i <= NF; ++i) printf "<%s>%s</%s>", tag, $i, tag; print "</tr>" }'
printf '</table>\n</body></html>\n'
