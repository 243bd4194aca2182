# A bead that runs over an edge of a plate: B ends at the part, S is open on that side, and the chain runs: where the layout of
# touches goes over the edge, they are chosen where the plate is. Reference: the plate, z = 0.
awk 'BEGIN { srand(7)
    for (x = 0; x <= 60; x += 0.5) for (y = 0; y <= 40; y += 0.5) {
        r = (x - 30) ^ 2 / 64 + (y - 38.5) ^ 2 / 25
        print x, y, (r < 1 ? 1.5 * sqrt(1 - r) : 0) + 0.01 * (rand() + rand() - 1) } }' > part.xyz
fettle-find part.xyz --file-units mm --jobs jobs --template "$SAMPLES/jobs/hammer.json" --keep 1 --report found.json -o found.pcd
jq -e '.anomalies | length == 1' found.json
jq -e '[.frame.position[1] as $y | .anomaly[][1] + $y] | max | . > 39 and . < 40.3' jobs/1.json
fettle-sample jobs/1.json --on part.xyz -q -o samples.pcd
fettle-fit jobs/1.json samples.pcd -q | fettle-margin jobs/1.json -q -o desired.json
fettle-plan jobs/1.json desired.json -q | fettle-grind --stock part.xyz -q -o ground.pcd
fettle-clean ground.pcd --crop jobs/1.json --format csv | awk -F , 'NR > 1 { n++; if ($3 > 0.2 || $3 < -0.1) bad++ } END { exit !(n > 300 && bad < 0.05 * n) }'
