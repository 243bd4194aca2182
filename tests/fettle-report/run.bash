# A whole run of Wang's part 1, small: job.json, samples.pcd, desired.json, plan.json, ground.pcd, trace.pcd, errors.pcd,
# with the reports plan-report.json, grind.json, errors.json and align.json, form.json. `page` makes its page.
job=$SAMPLES/jobs/wang1.json
fettle-part "$SAMPLES/parts/wang1.json" -o part.stl
fettle-part "$SAMPLES/parts/wang1.json" --without-anomaly -o truth.stl
fettle-sample "$job" --on part.stl --noise normal:0.005 -o samples.pcd
fettle-estimate "$job" samples.pcd | fettle-fit "$job" | fettle-margin "$job" -o desired.json
fettle-plan "$job" desired.json --report plan-report.json -o plan.json
fettle-grind plan.json --stock part.stl --cell 0.02 --trace trace.pcd --report grind.json -o ground.pcd
fettle-compare ground.pcd --to truth.stl --within "$job" --tolerance 0.0157 --report errors.json -o errors.pcd || test $? -eq 1
fettle-align ground.pcd --to truth.stl --to-units in --near --report align.json -o /dev/null
fettle-form flatness ground.pcd --within "$job" -o form.json

page() { # OPTION…
    fettle-report --job "$job" --samples samples.pcd --surface desired.json --plan plan.json --grinding grind.json \
        --trace trace.pcd --before part.stl --after ground.pcd --errors errors.pcd --comparison errors.json \
        --alignment align.json --form form.json "$@"
}
