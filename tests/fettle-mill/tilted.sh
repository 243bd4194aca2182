# 3+2 axes: a part that is tilted with its tool, its stock and its path is machined as the upright one, and judged as it: the same
# patches and errors, turned. The turn is about Y and takes (0, 0, 1) to (0.6, 0, 0.8); the stock is a mesh, or a box that
# comes to the same cut where it is machined. Points are in M, programs in the tilted frame. Reference: the upright part.
turn() { awk 'NF == 3 && NR > 2 { x = 0.8 * $1 + 0.6 * $3; z = -0.6 * $1 + 0.8 * $3; $1 = sprintf("%.12g", x); $3 = sprintf("%.12g", z) } { print }'; }
awk 'BEGIN { print "OFF"; n = 20; print (n + 1) ^ 2, 2 * n * n, 0
    for (j = 0; j <= n; j++) for (i = 0; i <= n; i++) printf "%.9g %.9g %.9g\n", i - 10, j - 10, 0.3 * cos(i / 3) + 0.2 * sin(j / 4)
    for (j = 0; j < n; j++) for (i = 0; i < n; i++) { k = j * (n + 1) + i; print 3, k, k + 1, k + n + 2; print 3, k, k + n + 2, k + n + 1 } }' > design.off
printf 'OFF\n4 1 0\n-9 -9 2\n9 -9 2\n9 9 2\n-9 9 2\n4 0 1 2 3\n' > stock.off
for mesh in design stock; do turn < $mesh.off > tilted-$mesh.off; done
axis="--axis 0.6,0,0.8"
finish="--cutter ball:4 --step-over 0.5"
fettle-finish design.off $finish > path.nc
fettle-finish tilted-design.off $axis $finish > tilted.nc
fettle-finish tilted-design.off $axis $finish --pcd > tilted.pcd
mill="--cutter ball:4 --step 0.25 -q"
fettle-mill path.nc --stock stock.off $mill --trace trace.pcd -o part.stl --report part.json
fettle-verify part.stl --design design.off --tolerance 0.1 --method closest --report upright.json > patches.pcd
for path in tilted.nc tilted.pcd; do
    fettle-mill $path $axis --stock tilted-stock.off $mill -o tilted.stl --report tilted.json
    jq -e --slurpfile part part.json '(.removed_volume / $part[0].removed_volume - 1 | fabs) < 1e-4 and .columns == $part[0].columns' tilted.json > ok
    fettle-verify tilted.stl $axis --design tilted-design.off --tolerance 0.1 --method closest --report tilted.json --ascii > tilted-patches.pcd
    jq -e --slurpfile up upright.json '(.rms - $up[0].rms | fabs) < 1e-4 and (.min - $up[0].min | fabs) < 1e-3 and .count == $up[0].count' tilted.json > ok
done
# Turned back, the tilted part is the upright one: its first vertices.
awk '/^DATA/ { body = 1; next } body && n++ < 50 { x = 0.8 * $1 - 0.6 * $3; if (x < -9.1 || x > 9.1 || $2 < -9.1 || $2 > 9.1) exit 1 } END { if (n < 50) exit 1 }' tilted-patches.pcd
# A tilted box: the plane that a flat cutter leaves lies across the axis.
printf 'G0 X-20 Y-3 Z20\nG1 Z4 F600\nX20\nY0\nX-20\nY3\nX20\nG0 Z20\n' > flat.nc
fettle-mill flat.nc $axis --stock box:-4,-4,-4,4,4,6 --cutter flat:4 --step 0.2 --pcd --ascii -q --report box.json > box.pcd || test $? = 1
awk '/^DATA/ { body = 1; next } body && $4 > 1e-6 { n++; h = 0.6 * $1 + 0.8 * $3; if (h < 4 - 1e-5 || h > 4 + 1e-5) exit 1 } END { if (n < 50) exit 1 }' box.pcd
status=0
fettle-mill tilted.pcd --axis 0,0,0 --stock tilted-stock.off $mill > part.stl 2> message || status=$?
[ $status = 2 ]
grep -q -- '--axis' message
printf 'x y z qw qx qy qz\n0 0 9 1 0 0 0\n1 0 9 1 0 0 0\n' > upright.xyz
status=0
fettle-mill upright.xyz $axis --stock tilted-stock.off $mill > part.stl 2> message || status=$?
[ $status = 2 ]
grep -q "point 1: the cutter's axis is 0, 0, 1, expected 0.6, 0, 0.8" message
printf 'x y z qw qx qy qz\n0 0 9 0.9486832980505138 0 0.31622776601683794 0\n1 0 9 0.9486832980505138 0 0.31622776601683794 0\n' > along.xyz
fettle-mill along.xyz $axis --stock tilted-stock.off $mill > part.stl
