# One job in inches and in mm ends in the same error map. Reference: identity; float coordinates in inches and in mm
# round differently, by some 4e-6 mm.
jq '(.. | numbers) *= 1
    | .units = {length: "mm", force: "N"}
    | (.anomaly, .sampling) |= map(map(. * 25.4))
    | .probe.accuracy *= 25.4 | .tolerance *= 25.4 | .safe_height *= 25.4
    | (.wheel.radius, .wheel.width, .wheel.min_radius) *= 25.4
    | (.force.min, .force.down, .force.max) *= 4.4482216152605 | .force.stiffness *= 4.4482216152605 / 25.4
    | (.feed.rate, .feed.step_over) *= 25.4 | .removal.coefficient *= 25.4 * 25.4 * 25.4 / 4.4482216152605' \
    "$SAMPLES/jobs/wang3.json" >mm.json
cp "$SAMPLES/jobs/wang3.json" in.json
cd "$SAMPLES/.."
here=$OLDPWD
fettle-part samples/parts/wang3.json -o "$here/part.stl"
fettle-part samples/parts/wang3.json --without-anomaly -o "$here/truth.stl"
cd "$here"
for unit in in mm; do
    cell=$([ $unit = in ] && echo 0.02 || echo 0.508)
    noise=$([ $unit = in ] && echo 0.005 || echo 0.127)
    fettle-sample $unit.json --on part.stl --on-units in --noise normal:$noise >samples.pcd
    fettle-estimate $unit.json samples.pcd | fettle-fit $unit.json | fettle-margin $unit.json >desired.json
    fettle-plan $unit.json desired.json >plan.json
    fettle-grind plan.json --stock part.stl --stock-units in --gantry virtual --cell $cell >ground.pcd
    fettle-compare ground.pcd --to truth.stl --to-units in --within $unit.json --report $unit.report.json -o /dev/null || test $? -eq 1
done
jq '{count, mean, min, max, rms, p50} | (.mean, .min, .max, .rms, .p50) *= 25.4' in.report.json >a.json
jq '{count, mean, min, max, rms, p50}' mm.report.json >b.json
fettle-diff --tol 1e-4 a.json b.json
