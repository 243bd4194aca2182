# Sourced by cases that do the same work in mm and N and in inches and pounds: the powers of length and force in every field of a PCD and
# every key of a report (tests/scales).
# shellcheck disable=SC2034
dimensions='{"x": [1, 0], "y": [1, 0], "z": [1, 0], "removed": [1, 0], "deflection": [1, 0], "radius": [1, 0], "feed": [1, 0],
"wheel_radius": [1, 0], "removed_volume": [3, 0], "force": [0, 1], "peak_force": [0, 1], "t": [0, 0], "layer": [0, 0],
"pass": [0, 0], "event": [0, 0], "machine_time": [0, 0], "grinding_time": [0, 0], "travel_time": [0, 0],
"service_time": [0, 0], "contact_time": [0, 0], "within": [0, 0], "layers": [0, 0], "coverings": [0, 0], "strokes": [0, 0],
"re_cuts": [0, 0], "skipped_re_cuts": [0, 0], "peak_at": [1, 0], "peak_layer": [0, 0], "in_range": [0, 0], "raises": [0, 0], "passes": [0, 0], "steps": [0, 0], "touch_offs": [0, 0], "wheel_changes": [0, 0],
"dropped_facets": [0, 0], "loops": null}'
kInch=25.4 kPound=4.4482216152605
inch_job() { # of job.json, in in-job.json
    jq --argjson l $kInch --argjson f $kPound '.units = {length: "in", force: "lbf"} | .anomaly |= map(map(. / $l)) |
        .tolerance /= $l | .safe_height /= $l | .wheel |= map_values(. / $l) | .force.stiffness *= $l |
        .force |= map_values(. / $f) | .feed |= map_values(. / $l) | .removal.coefficient *= $f / ($l * $l * $l)' job.json > in-job.json
}
