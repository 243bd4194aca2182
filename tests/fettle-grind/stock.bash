# Sourced by the cases: a plane at z = 5 mm with a hill of 4 x 3 mm, 40 x 40 mm in all, and a job and plan for it:
# layers 0.5 mm apart, a wheel of 10 mm radius and 2 mm width. `theta` turns B and the passes.
make_job() { # THETA_DEG
    jq -n --argjson theta "$1" '($theta * 3.141592653589793 / 180) as $a |
        def turned: [.[0] * ($a | cos) - .[1] * ($a | sin), .[0] * ($a | sin) + .[1] * ($a | cos)];
        {kind: "job", units: {length: "mm", force: "N"}, frame: {theta_deg: $theta}, surface: {type: "plane"},
        anomaly: [[-6, -6], [6, -6], [6, 6], [-6, 6]] | map(turned), tolerance: 0.1, safe_height: 20,
        wheel: {radius: 10, width: 2, min_radius: 5}, force: {min: 5, down: 10, max: 15, stiffness: 10},
        feed: {rate: 20, step_over: 1.5}, removal: {coefficient: 1}}' > job.json
    echo '{"kind": "surface", "units": {"length": "mm"}, "shape": {"type": "plane", "origin": [0, 0], "z0": 5, "slope": [0, 0]}}' > surface.json
    fettle-plan job.json surface.json > plan.json
}
make_stock() { # HEIGHT
    jq -n --argjson h "$1" '{kind: "part", units: {length: "mm"}, surface: {type: "plane", point: [0, 0, 5]},
        region: {x: [-20, 20], y: [-20, 20]}, step: 0.5,
        anomalies: [{type: "hill", centre: [0.5, -0.5], semi_axes: [4, 3], height: $h}]}' > part.json
    fettle-part part.json > stock.stl
}
