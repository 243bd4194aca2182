# What fettle-plan writes for Grbl is a program whose every word is known here. Its rapid moves keep off a stock that is
# 0.01 in (0.254 mm) too high, its passes cut it by just that.
echo '{"kind": "surface", "units": {"length": "in"}, "shape": {"type": "plane", "origin": [0, 0], "z0": 0.75, "slope": [0, 0]}}' |
    fettle-plan "$SAMPLES/jobs/wang1.json" --gcode grbl > layer1.ngc
fettle-mill layer1.ngc --stock box:-40,-40,0,40,40,19.304 --cutter flat:12.7 --step 0.5 --report report.json > machined.stl
jq -e '.rapid_cuts.moves == 0 and .words_without_motion.M30 == 1 and (.deepest_cut - 0.254 | fabs) < 1e-3' report.json > ok
