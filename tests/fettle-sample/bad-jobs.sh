# Every job that must be refused, with the file, the key or the place, and the value.
cat > good.json <<'JOB'
{"kind": "job", "units": {"length": "in", "force": "lbf"}, "surface": {"type": "freeform"},
 "anomaly": [[1, 1], [2, 1], [2, 2], [1, 2]], "sampling": [[0, 0], [3, 0], [3, 3], [0, 3]],
 "wheel": {"width": 0.25}, "force": {"min": 5, "down": 10, "max": 15, "stiffness": 200}, "feed": {"rate": 1, "step_over": 0.2}}
JOB
fettle-sample good.json --plan-only > plan.pcd
bad() { # CHANGE MESSAGE
    jq "$1" good.json > bad.json
    "$HERE/../refuses" "fettle-sample: bad.json: $2" fettle-sample bad.json --plan-only
}
bad '.anomaly = [[1, 1], [2, 1]]' 'anomaly: 2 boundary points, at least 3 are needed'
bad '.anomaly = [[1, 1], [2, 2], [2, 1], [1, 2]]' 'anomaly: the boundary crosses itself at (1.5, 1.5) in'
bad '.anomaly = [[1, 1], [1.5, 1.5], [2, 2]]' 'anomaly: the boundary encloses no area, near (1, 1) in'
bad '.anomaly = [[1, 1], [4, 1], [2, 2]]' "anomaly: not inside the sampling boundary's convex hull, at (4, 1) in"
bad '.anomaly = .sampling' 'sampling: no room between anomaly and sampling boundary, near (0, 0) in'
bad 'del(.sampling)' 'sampling: missing'
bad 'del(.units)' 'units: missing'
bad 'del(.units.force)' 'units.force: missing'
bad '.units.length = "m"' 'units.length: "m" is none of mm, in'
bad '.kind = "plan"' 'kind: expected "job", got "plan"'
bad '.force.min = 20' 'force.max: must be above min, 20, got 15'
bad '.force.down = 20' 'force.down: must lie between min and max, 5 and 15, got 20'
bad '.force.stiffness = 0' 'force.stiffness: must be positive, got 0'
bad '.feed.rate = -1' 'feed.rate: must be positive, got -1'
bad '.feed.step_over = 0.5' 'feed.step_over: wider than the wheel, 0.25: 0.5 leaves ridges'
bad '.surface.type = "freefrom"' 'surface.type: "freefrom" is none of plane, swept, freeform; did you mean "freeform"?'
bad '.surface.type = "swept"' 'surface.direction_deg: missing'
bad '.tolerence = 1' 'tolerence: unknown key, did you mean "tolerance"?'
bad '.anomaly[1] = [1]' 'anomaly[1]: expected 2 to 3 numbers, got 1'
bad '.anomaly[1][0] = null' 'anomaly[1][0]: expected a number, got null'
bad '.anomaly = [[0, 1], [1, 1], [1, 2], [0, 2]]' 'sampling: no room to touch on both sides of the anomaly, on the line through (0, 1.33333) in'
printf '%s\n' '0 0 0' '3 0 0' '3 3 0' '0 3 0' >part.xyz
jq '.probe.tip_radius = 1.1' good.json >bad.json
"$HERE/../refuses" "fettle-sample: bad.json: a probe's tip of radius 1.1 is larger than the anomaly, 1 across" fettle-sample bad.json --on part.xyz
# clockwise polygons are no mistake
jq '.anomaly |= reverse | .sampling |= reverse' good.json > clockwise.json
fettle-sample clockwise.json --plan-only | cmp plan.pcd -
