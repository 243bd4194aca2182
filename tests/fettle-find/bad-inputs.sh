# What has no surface to find anything on, or is asked for wrongly: status 2 and one line that names it. What has some is searched.
refuses() { "$HERE/../refuses" "$1" fettle-find "${@:2}"; }
refuses 'missing.pcd: cannot open' missing.pcd
: > empty
refuses 'empty: ' empty
printf 'nan 0 0\nnan 1 0\n' > none.xyz
refuses 'none.xyz: no surface' none.xyz
printf '1 2 3\n' > one.xyz
refuses 'one.xyz: no surface' one.xyz
awk 'BEGIN { for (i = 0; i < 50; ++i) print 1, 2, 3 }' > same.xyz
refuses 'same.xyz: no surface' same.xyz
awk 'BEGIN { for (y = 0; y < 40; ++y) for (x = 0; x < 40; ++x) print x, y, 0; print 1e7, 1e7, 0 }' > far.xyz
refuses 'far.xyz: the points lie too far apart' far.xyz
printf 'OFF\n3 1 0\n0 0 0\n9 0 0\n0 9 0\n3 0 1 2\n' > facet.off
refuses '--drop: 1 is no row: 0 anomalies were found' facet.off --drop 1
refuses "--keep: expected a number, got 'one'" facet.off --keep one
refuses '--against: is needed by --transform-in' facet.off --transform-in T.txt
refuses "left.stl: '.stl' is no format of this output: .pcd, .ply, .csv, .vtk" same.xyz -o left.stl
[ ! -e left.stl ]

awk 'BEGIN { for (x = 0; x < 500; ++x) print x / 10, 0, sin(x / 90) }' > profile.xyz
refuses 'profile.xyz: no surface: its points lie on lines, as those of a single profile' profile.xyz
# A reference of another part: a field could bend any part onto any other. Reference: the plate and the hammer's head.
refuses 'is not the part of the reference' "$SAMPLES/scans/hammer.stl" --against "$SAMPLES/designs/plate.stl"

# Points without any order, a sheet with a block of NaN, two sheets far apart: nothing is found, and nothing is wrong.
awk 'BEGIN { srand(5); for (i = 0; i < 2000; ++i) print 99 * rand(), 99 * rand(), 99 * rand() }' > scattered.xyz
awk 'BEGIN { for (y = 0; y < 60; ++y) for (x = 0; x < 60; ++x) if (x > 20 && x < 35 && y > 20 && y < 35) print "nan nan nan"; else print x, y, 0.001 * x * x }' > block.xyz
awk 'BEGIN { for (y = 0; y < 60; ++y) for (x = 0; x < 60; ++x) { print x, y, 0.01 * x; print x + 300, y, 40 } }' > two.xyz
for part in scattered block two; do
    fettle-find $part.xyz --report $part.json > $part.pcd
    jq -e '.anomalies == []' $part.json > ok
done

# One vertex, or one point, far off takes no more memory for it.
awk 'BEGIN { for (y = 0; y < 12; ++y) for (x = 0; x < 12; ++x) print x, (x + y ? y : 1e12), sin(x) }' > far.xyz
(ulimit -v 2000000; refuses 'far.xyz: the points lie too far apart for a map of 20 million cells' far.xyz)
printf 'OFF\n4 4 0\n0 0 0\n9 0 0\n0 9 0\n0 -2e10 9\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n' > far.off
(ulimit -v 2000000; fettle-find far.off --threads 2 --report far.json -q > far.pcd)
jq -e '.anomalies == []' far.json > ok
