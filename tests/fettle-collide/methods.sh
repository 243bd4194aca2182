# Grids of cuboids, and triangles under the tool: the verdicts of the triangles alone, clearances never larger. Reference: --method exact.
fettle-part "$SAMPLES/parts/keel.json" >keel.stl
robot=$SAMPLES/robots/irb1400.json
fettle-arm "$robot" --inverse "$SAMPLES/paths/keel.pcd" -q -o joints.pcd
check() { fettle-collide "$robot" "$1" --workpiece keel.stl --method "$2" "${@:4}" --report "$3.json" -q --ascii >"$3.pcd" || test $? -eq 1; }
check joints.pcd exact exact
check joints.pcd grid grid
check joints.pcd grid fine --cell 0.5
jq -es '.[0].collisions == 0 and .[1].collisions == 0 and (.[1].min.clearance - .[0].min.clearance | fabs) < 1e-6 and
    .[1].grids >= 1 and .[1].cell == 1 and .[2].cell == 0.5 and .[2].cuboids_too_near < .[1].cuboids_too_near and
    .[0].grids == null' exact.json grid.json fine.json >/dev/null
clearances() { awk '/^FIELDS/ { for (i = 2; i <= NF; ++i) if ($i == "clearance") n = i - 1 } data { print $n } /^DATA/ { data = 1 }' "$1"; }
paste <(clearances exact.pcd) <(clearances grid.pcd) | awk '$2 > $1 + 1e-6 { bad = 1 } END { exit bad || NR != 61 }'
# 0.1 mm lower it gouges at every pose
fettle-arm "$robot" --forward joints.pcd --ascii | awk 'data { $3 -= 0.1 } { print } $1 == "DATA" { data = 1 }' | sed 's/joint/j/g' >low.pcd
check low.pcd grid deep
check low.pcd paper paper
jq -es '.[0].collisions == 61 and .[0].min.pair == ["ball", "workpiece"] and .[1].collisions == 61' deep.json paper.json >/dev/null
# the same bytes for any number of threads
fettle-collide "$robot" joints.pcd --workpiece keel.stl --method grid --threads 1 -q --ascii | cmp - grid.pcd
refuses() { "$HERE/../refuses" "$@" </dev/null; }
fettle-collide "$robot" joints.pcd --workpiece keel.stl --exact -q --ascii | cmp - exact.pcd
refuses '--exact: and --method grid' fettle-collide "$robot" joints.pcd --workpiece keel.stl --exact --method grid
refuses '--method' fettle-collide "$robot" joints.pcd --method grid
refuses '--method' fettle-collide "$robot" joints.pcd --workpiece keel.stl --method other
refuses '--cell' fettle-collide "$robot" joints.pcd --workpiece keel.stl --method grid --cell 0
refuses '--cell: ' fettle-collide "$robot" joints.pcd --workpiece keel.stl --method grid --cell 0.001
refuses '--tolerance: 0 ' fettle-collide "$robot" joints.pcd --workpiece keel.stl --method paper --tolerance 0
