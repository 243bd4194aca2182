# Forces 5, 10, 15 lbf on 200 lbf/in: layers 0.05 in thick (Wang 2007, eq. 5-1), 0.025 in apart (5-2), case 3. The highest
# reference surface below the safe height, 1.25 in over the surface, is that of layer 51. Start: smallest x, then smallest y.
# Passes: 10 of 2 in, the outer ones flush with B: their lines at 0.625 and 2.375 in.
echo '{"kind": "surface", "units": {"length": "in"}, "shape": {"type": "plane", "origin": [0, 0], "z0": 0.75, "slope": [0, 0]}}' |
    fettle-plan "$SAMPLES/jobs/wang1.json" - --report report.json > plan.json
jq -e '(.layer_thickness - 0.05 | fabs) < 1e-12 and (.layer_distance - 0.025 | fabs) < 1e-12 and .overlap_case == 3 and
       .max_layers == 51 and .passes == 10 and (.covering_length - 20 | fabs) < 1e-9' report.json > passes
jq -e '(.start[0] - 0.5 | fabs) < 1e-12 and (.start[1] - 0.5 | fabs) < 1e-12 and (.start[2] - 0.75 | fabs) < 1e-12 and
       .passes[0].from == [0.625, 0.5] and (.passes[9].from[0] - 2.375 | fabs) < 0.0032 and .units.length == "in"' plan.json > passes
