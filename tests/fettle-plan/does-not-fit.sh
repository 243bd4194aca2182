# A wheel of 3 in in a hollow of 2.9 in radius, and one of 0.25 in width across a curvature of radius 1.5 in (its edges
# are off by 0.0052 in, the tolerance is 0.004), are refused with the place (Wang 2007, 3.4).
refused() { # RADIUS AXIS
    jq -n "{kind: \"surface\", units: {length: \"in\"}, shape: {type: \"cylinder\",
        point: [1.5, 1.5, 0.75], normal: [0, 0, 1], axis: $2, curvature: (-1 / $1)}}" > surface.json
    status=0
    fettle-plan job.json surface.json > out 2> message || status=$?
    [ $status = 2 ]
    [ ! -s out ]
    [ "$(wc -l < message)" = 1 ]
    cat message
}
jq '.wheel.radius = 3' "$SAMPLES/jobs/wang1.json" > job.json
refused 2.9 '[1, 0, 0]'
cp "$SAMPLES/jobs/wang1.json" job.json
refused 1.5 '[0, 1, 0]'
