# A whole session by a file of events, on each simulated gantry and through a driver: every file is what the chain of tools makes of
# the file before it, byte for byte. References: those tools, the corners shown, the plane.
# shellcheck source=tests/fettle-station/kit.bash
. "$HERE/kit.bash"
make_job 0
make_stock 4
{ show; echo '3 start'; } > steer.txt
jq '.anomaly |= map(map(. * 2))' job.json > wide.json # what the driver's machine has under it
for kind in virtual virtual:dynamic exec; do
    options=(--gantry $kind)
    [ $kind != virtual:dynamic ] || options+=(--machine "$machine")
    [ $kind != exec ] || options=(--gantry "exec:fettle-gantry-virtual wide.json --stock stock.stl --cell 0.2")
    station "$kind" steer.txt "${options[@]}" --report report.json
    jq -e '.kind == "station" and .stage == "done" and .finished and .anomaly_points == 4 and .touches == 4 and .stops == [] and .peak_force > 0' report.json > ok
    cd "$kind"
    jq -e '[.anomaly, [[-7, -7, 5], [7, -7, 5], [7, 7, 5], [-7, 7, 5]]] | map(flatten) | transpose | map(.[0] - .[1] | fabs) | max < 0.01' job.json > ok
    fettle-fit job.json samples.pcd | fettle-margin job.json | cmp - surface.json
    fettle-plan job.json surface.json | cmp - plan.json
    grep -q '<html' page.html
    if [ $kind = exec ]; then
        fettle-grind plan.json --stock ../stock.stl --cell 0.2 --trace reference.pcd --ascii > ground.ref \
            --gantry 'exec:fettle-gantry-virtual ../wide.json --stock ../stock.stl --cell 0.2'
    else
        fettle-grind plan.json --stock ../stock.stl --cell 0.2 "${options[@]}" --trace reference.pcd --ascii > ground.ref
    fi
    if [ $kind != exec ]; then cmp reference.pcd trace.pcd; fi # a driver's clock and place are those after the touches
    fettle-diff --tol 0.02 ground.ref ground.pcd
    is_flat "$(jq .prediction.shift surface.json)" ground.pcd
    cd ..
done

# The touches are those that fettle-sample makes on the part.
fettle-sample virtual/job.json --on stock.stl > samples.ref
fettle-diff --tol 0.006 samples.ref virtual/samples.pcd # the resolution of the drive

# Without a point the job's boundaries hold. The head is turned by degrees.
printf '0 next\n0 next\n0 start\n0 end\n' > keep.txt
cp virtual/job.json job.json
ends_with 1 station kept keep.txt --gantry virtual --report report.json
jq -e '.stage == "review" and .predicted_band > 0' report.json > ok
fettle-diff virtual/job.json kept/job.json
printf '0 turn_left\n0 turn_left\n0 turn_left\n0 turn_right\n0 next\n0 next\n0 end\n' > turn.txt
ends_with 1 station turned turn.txt --gantry virtual
jq -e '(.job.frame.theta_deg - 2 | fabs) < 1e-9 and .stage == "touch"' turned/session.json > ok
