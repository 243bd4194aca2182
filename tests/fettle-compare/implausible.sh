# A reference in another unit than is taken cannot hold the job's boundary, or is far too large for it: a warning of one
# line, and the comparison all the same. Reference: the files' own sizes.
echo '{"kind": "job", "units": {"length": "mm"}, "surface": {"type": "plane"},
  "anomaly": [[10, 10], [20, 10], [20, 20], [10, 20]]}' >job.json
square() { # SIDE: two facets in z = 0
    printf 'solid s\n'
    printf 'facet normal 0 0 1\nouter loop\nvertex %s %s 0\nvertex %s %s 0\nvertex %s %s 0\nendloop\nendfacet\n' \
        0 0 "$1" 0 "$1" "$1" 0 0 "$1" "$1" 0 "$1"
    printf 'endsolid s\n'
}
square 30 >part.stl
square 0.03 >metres.stl
echo '15 15 0' >test.xyz
compare() { fettle-compare test.xyz --within job.json --tolerance 1 "$@" -o errors.pcd 2>warning; }
compare --to part.stl
[ ! -s warning ]
! compare --to metres.stl || exit 1
grep -qxF "fettle-compare: warning: metres.stl: the part, 0.03 x 0.03 x 0 mm, does not contain the job's boundary: is its unit right?" warning
compare --to metres.stl --to-units m
[ ! -s warning ]
compare --to part.stl --to-units m
grep -qxF "fettle-compare: warning: part.stl: the part, 30000 x 30000 x 0 mm, is over 100 times as long as the job's boundary: is its unit right?" warning
compare --to part.stl --to-units m -q
[ ! -s warning ]
awk 'BEGIN { for (i = 0; i <= 30; i++) for (j = 0; j <= 30; j++) print i / 1000, j / 1000, 0 }' >metres.xyz
! compare --to metres.xyz || exit 1
grep -qxF "fettle-compare: warning: metres.xyz: the part, 0.03 x 0.03 x 0 mm, does not contain the job's boundary: is its unit right?" warning
compare --to metres.xyz --to-units m
[ ! -s warning ]
