# A bead on a cylinder that bends too much for the template's wheel: the job gets the first wheel of --wheels that fits, with its forces and
# step-over, and says why; the chain runs with it, and not with the template's. Reference: the cylinder of radius 30, whose sag over a width w is w²/240.
awk 'BEGIN { srand(3)
    for (x = -18; x <= 18; x += 0.5) for (y = -22; y <= 22; y += 0.5) {
        r = x ^ 2 / 16 + y ^ 2 / 49
        print x, y, sqrt(900 - x ^ 2) - 30 + (r < 1 ? 1.5 * sqrt(1 - r) : 0) + 0.01 * (rand() + rand() - 1) } }' > part.xyz
jq '.tolerance = 0.1 | .probe.accuracy = 0.02 | .wheel.width = 8 | .feed.step_over = 6' "$SAMPLES/jobs/hammer.json" > wide.json
jq '.wheel.width = 6 | .feed.step_over = 4' wide.json > middle.json
jq '.wheel.width = 3 | .feed.step_over = 2 | .force.max = 14' wide.json > narrow.json
fettle-find part.xyz --file-units mm --jobs jobs --template wide.json --keep 1 --report found.json -o found.pcd --wheels middle.json narrow.json 2> said
grep -q 'fettle-find: warning: jobs/1.json: the surface bends too much across a wheel 8 mm wide: that of narrow.json fits' said
jq -e '.anomalies | length == 1 and (.[0].wheel | contains("narrow.json"))' found.json
jq -e --slurpfile n narrow.json '.wheel == $n[0].wheel and .force == $n[0].force and .feed.step_over == 2 and .tolerance == 0.1' jobs/1.json
fettle-sample jobs/1.json --on part.xyz -q | fettle-fit jobs/1.json -q | fettle-margin jobs/1.json -q -o desired.json
fettle-plan jobs/1.json desired.json -q -o plan.json
jq '.wheel.width = 8' jobs/1.json > refused.json
"$HERE/../refuses" 'refused.json: wheel.width: 8 across a curvature of radius' fettle-plan refused.json desired.json
# Without another wheel the job says what would fit: √(8 · 0.1 · 30) is 4.9 mm.
fettle-find part.xyz --file-units mm --jobs alone --template wide.json --keep 1 -q -o found.pcd
jq -e '.wheel.width > 2 and .wheel.width < 4.9' alone/1.json
"$HERE/../refuses" '--wheels: --jobs and --wheels go together' fettle-find part.xyz --file-units mm --wheels narrow.json
