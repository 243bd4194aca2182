# A damaged mesh: one of its vertices is as far as the moon. The others are measured as if it were not there, in no more time, and it is named.
# Reference: the points are the mesh's other vertices, so that all distances are 0.
sheet() { # MOVED
    awk -v moved="$1" 'BEGIN {
        print "OFF"; print 201 * 201, 2 * 200 * 200, 0
        for (y = 0; y < 201; ++y) for (x = 0; x < 201; ++x) if (moved && x == 90 && y == 70) print "3.84e8 1e8 -2e8"; else print x, y, sin(x / 9) + cos(y / 7)
        for (y = 0; y < 200; ++y) for (x = 0; x < 200; ++x) { a = 201 * y + x; print 3, a, a + 1, a + 202; print 3, a, a + 202, a + 201 } }'
}
sheet 1 > damaged.off
sheet 0 | awk 'NR > 2 && NF == 3 && !($1 == 90 && $2 == 70)' > points.xyz
( ulimit -t 5; fettle-compare points.xyz --to damaged.off --file-units mm --max-distance 0.001 --report r.json -o errors.pcd ) 2> err
jq -e '.count + .undefined == 40400 and .undefined == 0 and .max < 1e-5 and .min > -1e-5' r.json
grep -q 'damaged.off: a point at (3.84e+08, 1e+08, -2e+08) mm lies .* times as far from the middle as half of them: is the file damaged?' err

# Registration depends on how far both extend: refused.
"$HERE/../refuses" 'damaged.off: a point at (3.84e+08, 1e+08, -2e+08) mm lies' fettle-align points.xyz --to damaged.off --file-units mm
"$HERE/../refuses" 'damaged.off: a point at (3.84e+08, 1e+08, -2e+08) mm lies' fettle-align damaged.off --to points.xyz
"$HERE/../refuses" 'damaged.off: a point at (3.84e+08, 1e+08, -2e+08) mm lies' fettle-find points.xyz --against damaged.off --file-units mm
"$HERE/../refuses" 'damaged.off: a point at (3.84e+08, 1e+08, -2e+08) mm lies' fettle-find damaged.off --against points.xyz
