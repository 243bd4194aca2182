# One job in inches and in mm gives the same touches, and so does a part in metres that is said to be. Reference:
# identity; 1e-4 mm is the resolution of the float coordinates.
cat > in.json <<'JOB'
{"kind": "job", "units": {"length": "in"}, "surface": {"type": "freeform"},
 "anomaly": [[1, 1], [3.25, 1], [3.25, 1.75], [1, 1.75]], "sampling": [[0, 0], [4.5, 0], [4.5, 3], [0, 3]]}
JOB
jq '.units.length = "mm" | (.anomaly, .sampling) |= map(map(. * 25.4))' in.json > mm.json
facet() { # UNIT
    awk -v u="$1" 'BEGIN { print "solid f\nfacet normal 0 0 1\nouter loop"
        printf "vertex %.9g %.9g %.9g\n", -10 * u, -10 * u, 0
        printf "vertex %.9g %.9g %.9g\n", 500 * u, -10 * u, 51 * u
        printf "vertex %.9g %.9g %.9g\n", -10 * u, 500 * u, 102 * u
        print "endloop\nendfacet\nendsolid f" }'
}
facet 1 > mm.stl
facet 0.001 > m.stl
values() { grep '^DATA' -A 99 | tail -n +2 | awk -v u="$1" '{ printf "%.3f %.3f %.3f %d %d\n", $1 * u + 1e-5, $2 * u + 1e-5, $3 * u + 1e-5, $4, $5 }' | sort; }
fettle-sample mm.json --on mm.stl --ascii | values 1 > expected
fettle-sample mm.json --on m.stl --on-units m --ascii | values 1 | diff expected -
fettle-sample in.json --on mm.stl --on-units mm --ascii | values 25.4 | diff expected -
[ "$(wc -l < expected)" -gt 8 ]
# In a wrong unit that holds the boundary, too: the touches are far above the points that the operator touched.
fettle-part "$SAMPLES/parts/hammer.json" > hammer.stl
fettle-sample "$SAMPLES/jobs/hammer.json" --on hammer.stl --on-units in 2> warning > samples.pcd
grep -F "hammer.stl: the touches lie 668.932 mm above the job's boundary points: is the part's unit right" warning
fettle-sample "$SAMPLES/jobs/hammer.json" --on hammer.stl 2> warning > samples.pcd
[ ! -s warning ]
