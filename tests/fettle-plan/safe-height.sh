# A job that gives neither a safe height nor the z of a boundary point: the plan travels 2 in above the surface. Reference: the
# plane z = 3 in, whose highest layer then is the same as beneath a job that gives the height. A given height is kept.
jq 'del(.safe_height) | (.anomaly, .sampling) |= map(.[:2])' "$SAMPLES/jobs/wang1.json" >job.json
echo '{"kind": "surface", "units": {"length": "in"}, "shape": {"type": "plane", "origin": [0, 0], "z0": 3, "slope": [0, 0]}}' >surface.json
fettle-plan job.json surface.json >plan.json
jq -e '.job.safe_height == 5 and .bounds.layers == 81' plan.json
jq '.safe_height = 5' job.json >given.json
fettle-plan given.json surface.json | fettle-diff plan.json -
jq '.safe_height = 4' job.json | fettle-plan - surface.json | jq -e '.job.safe_height == 4'
jq '.safe_height = 2' job.json >low.json
"$HERE/../refuses" 'safe_height: 2 is not above the surface, 3 at' fettle-plan low.json surface.json
# With the part at hand it is 2 in over the part's top: a hill of 0.1 in on a plate at 3 in.
echo '{"kind": "part", "units": {"length": "in"}, "surface": {"type": "plane", "point": [0, 0, 3]}, "region": {"x": [0, 3], "y": [0, 3]},
    "step": 0.1, "anomalies": [{"type": "hill", "centre": [1.5, 1.5], "semi_axes": [0.3, 0.3], "height": 0.1}]}' | fettle-part -o hill.stl
fettle-plan job.json surface.json --f-down auto --stock hill.stl --stock-units in | jq -e '(.job.safe_height - 5.1 | fabs) < 1e-3'
# A machine behind a driver is not moved at a height that is a guess.
"$HERE/../refuses" 'gives neither safe_height nor the z of a boundary point' fettle-sample job.json --on gantry:exec:false
