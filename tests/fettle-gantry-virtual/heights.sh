# Touches through the protocol, on a tilted plane and on a sphere. Reference: their formulas. 0.0025 mm is half a count of the Z drive's encoder;
# the plane rises by 0.02 mm over half a cell, the sphere by no more.
cat > job.json << 'JSON'
{"kind": "job", "units": {"length": "mm", "force": "N"}, "surface": {"type": "plane"}, "anomaly": [[-6, -6], [6, -6], [6, 6], [-6, 6]], "safe_height": 20}
JSON
echo '{"kind": "surface", "units": {"length": "mm"}, "shape": {"type": "plane", "origin": [0, 0], "z0": 9, "slope": [0, 0]}}' > surface.json
fettle-plan job.json surface.json > plan.json
places='-5 -5 -2.5 4 0 0 1.5 -3 5.5 5.5'
touch_at() { # PART FORMULA-OF-AWK
    fettle-part "$1" > stock.stl
    { echo '1 connect fettle-gantry 1'; echo "$places" | xargs -n 2 | awk '{ print NR + 1, "probe", $1, $2, -50 }'; } |
        fettle-gantry-virtual plan.json --stock stock.stl --cell 0.1 | awk 'NR > 1 { print $3 }' | jq -cs '{z: .}' > touched.json
    echo "$places" | xargs -n 2 | awk "{ x = \$1; y = \$2; print $2 }" | jq -cs '{z: .}' > expected.json
    [ "$(jq '.z | length' touched.json)" = 5 ]
    fettle-diff touched.json expected.json --tol 0.0235
}
part() { jq -n --argjson s "$1" '{kind: "part", units: {length: "mm"}, surface: $s, region: {x: [-20, 20], y: [-20, 20]}, step: 0.25, anomalies: []}'; }
part '{"type": "plane", "point": [0, 0, 5], "slope": [0.3, -0.2]}' > plane.json
touch_at plane.json '5 + 0.3 * x - 0.2 * y'
part '{"type": "sphere", "centre": [0, 0, -90], "radius": 100}' > sphere.json
touch_at sphere.json 'sqrt(10000 - x * x - y * y) - 90'
