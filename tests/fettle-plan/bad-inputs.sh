# What is no job, no surface, or no command line ends with status 2, one line that names the file and the value, and
# nothing on stdout.
job="$SAMPLES/jobs/wang1.json"
echo '{"kind": "surface", "units": {"length": "in"}, "shape": {"type": "plane", "origin": [0, 0], "z0": 0.75, "slope": [0, 0]}}' > plane.json
: > empty.json
echo '{"kind": "surface", "units"' > truncated.json
jq '.shape.z0 = "high"' plane.json > word.json
jq '.shape.z0 = 3' plane.json > high.json
jq '.shape.slope = [10, 0] | .shape.z0 = -30' plane.json > steep.json
jq '.shape = {type: "sphere", point: [1.5, 1.5, 0.75], normal: [0, 0, 1], curvature: -2}' plane.json > small.json
jq '.feed.step_over = 0.3' "$job" > wide.json
printf '\0\1\2' > bytes
refused() {
    status=0
    "$@" > out 2> message || status=$?
    [ $status = 2 ] && [ ! -s out ] && [ "$(wc -l < message)" = 1 ] || { echo "$*: $status"; cat message; }
    sed "s|$SAMPLES/||" message
}
refused fettle-plan "$job" empty.json
refused fettle-plan "$job" truncated.json
refused fettle-plan "$job" bytes
refused fettle-plan "$job" word.json
refused fettle-plan "$job" "$job"
refused fettle-plan plane.json plane.json
refused fettle-plan "$job" high.json
refused fettle-plan "$job" steep.json
refused fettle-plan "$job" small.json
refused fettle-plan wide.json plane.json
refused fettle-plan "$job" missing.json
refused fettle-plan "$job" plane.json --gcode grbl -o /missing/layer1.ngc
refused fettle-plan
