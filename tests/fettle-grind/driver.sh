# Work through the driver's protocol leaves the same trace, byte for byte, as on the simulated machines themselves; and the
# part as the machine knows it is the part as it is, but for the wear of the wheel. References: each other.
# shellcheck source=tests/fettle-grind/stock.bash
. "$HERE/stock.bash"
make_job 30
make_stock 4
for machine in '' "--machine $SAMPLES/machines/full_scale.json"; do
    # shellcheck disable=SC2086
    fettle-grind plan.json --stock stock.stl --cell 0.1 --gantry "virtual${machine:+:dynamic}" $machine --trace direct.pcd > direct-ground.pcd
    fettle-grind plan.json --stock stock.stl --cell 0.1 --trace driven.pcd --report report.json \
        --gantry "exec:fettle-gantry-virtual plan.json --stock stock.stl --cell 0.1 $machine --ground truth.pcd" > driven-ground.pcd
    cmp direct.pcd driven.pcd
    jq -e '.finished' report.json > ok
    fettle-diff truth.pcd direct-ground.pcd
    fettle-diff --tol 0.05 driven-ground.pcd direct-ground.pcd
done
