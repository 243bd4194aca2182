# --f-down auto grinds the simulated part with several F_down from F_min on and takes the fastest. Reference: fettle-grind, with a job
# that asks for each. Where the metal yields a tenth, cuts are repeated, so the fastest is no smaller than in the job's metal.
# shellcheck source=tests/fettle-grind/stock.bash
. "$HERE/../fettle-grind/stock.bash"
make_job 0
make_stock 4
for factor in 1 0.1; do
    fettle-plan job.json surface.json --f-down auto --stock stock.stl --cell 0.1 --removal-factor $factor --report report.json > auto.json
    jq -e --slurpfile plan auto.json '.force_down as $f | ($f.trials | length) == 7 and $f.trials[0].force_down == 5 and
        ($f.trials | map(select(.finished)) | min_by(.machine_time) | .force_down) == $f.chosen and
        $plan[0].job.force.down == $f.chosen and (.layer_distance - (15 - $f.chosen) / 10 | fabs) < 1e-12' report.json
    jq .force_down.chosen report.json >> chosen
    for trial in 0 6; do
        jq --slurpfile report report.json ".force.down = \$report[0].force_down.trials[$trial].force_down" job.json > tried.json
        fettle-plan tried.json surface.json | fettle-grind --stock stock.stl --cell 0.1 --removal-factor $factor --report ground.json > ground.pcd
        jq -e --slurpfile ground ground.json ".force_down.trials[$trial] as \$t | \$ground[0] |
            .machine_time == \$t.machine_time and .layers == \$t.layers and .re_cuts == \$t.re_cuts and .peak_force == \$t.peak_force" report.json
    done
done
[ "$(sort -g chosen | tr '\n' ' ')" = "$(tr '\n' ' ' < chosen)" ]
"$HERE/../refuses" '--stock: the part, and --f-down auto, which simulates it, go together' fettle-plan job.json surface.json --f-down auto
"$HERE/../refuses" '--stock: the part, and --f-down auto, which simulates it, go together' fettle-plan job.json surface.json --stock stock.stl
"$HERE/../refuses" 'job.json: force.down: the work finishes with no value, with the smallest not because of: ' \
    fettle-plan job.json surface.json --f-down auto --stock stock.stl --cell 0.4 --removal-factor 1e-3
jq '.safe_height = 8' job.json > low.json
"$HERE/../refuses" 'stock.stl: stands at z 8' fettle-plan low.json surface.json --f-down auto --stock stock.stl
