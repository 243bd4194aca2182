# Layer 1 as G-code: units and feed on lines of their own, straight passes on a plane in one move each, at safe height
# between them. Reference: the job (10 passes of 2 in at 1 in/s = 60 in/min).
echo '{"kind": "surface", "units": {"length": "in"}, "shape": {"type": "plane", "origin": [0, 0], "z0": 0.75, "slope": [0, 0]}}' |
    fettle-plan "$SAMPLES/jobs/wang1.json" --gcode layer1.ngc > plan.json
head -n 11 layer1.ngc | tail -n 9
[ "$(grep -c '^G1 X' layer1.ngc)" = 10 ]
tail -n 1 layer1.ngc
