# A job in inches and the same in millimetres plan the same staircase. Reference: the identity 1 in = 25.4 mm.
for unit in in mm; do
    if [ $unit = in ]; then l=1 f=1; else l=25.4 f=4.4482216152605; fi
    jq -n --argjson l $l --argjson f $f --arg unit $unit '{kind: "job",
        units: {length: $unit, force: (if $unit == "in" then "lbf" else "N" end)}, frame: {theta_deg: 30},
        surface: {type: "plane"}, anomaly: [[0, 0], [2, 0.5], [1.8, 2], [0.2, 1.7]] | map(map(. * $l)),
        tolerance: (0.004 * $l), safe_height: (2 * $l), wheel: {radius: $l, width: (0.25 * $l), min_radius: (0.5 * $l)},
        force: {min: (5 * $f), down: (10 * $f), max: (15 * $f), stiffness: (200 * $f / $l)},
        feed: {rate: $l, step_over: (0.2 * $l)}, removal: {coefficient: (0.002 * $l * $l * $l / $f)}}' > job-$unit.json
    jq -n --argjson l $l --arg unit $unit '{kind: "surface", units: {length: $unit},
        shape: {type: "plane", origin: [0, 0], z0: (0.5 * $l), slope: [0.1, 0.05]}}' > surface-$unit.json
    fettle-plan job-$unit.json surface-$unit.json > plan-$unit.json
done
jq '[.passes[] | .from + .to | map(. * 25.4)]' plan-in.json > in.json
jq '[.passes[] | .from + .to]' plan-mm.json > mm.json
jq -e -n --slurpfile a in.json --slurpfile b mm.json '($a[0] | flatten) as $a | ($b[0] | flatten) as $b |
    ($a | length) == ($b | length) and ([range($a | length) | $a[.] - $b[.] | fabs] | max) < 1e-9' > same
