# The default goes on where Wang's layout predicts a band above the job's tolerance: on Wang's part 2, whose seven touches leave 0.16 mm of
# margin. The touches of the layout come first, unchanged; the rest keeps to S \ B; the operator bounds their number; a layout that is good
# enough stays alone. References: --strategy wang, the job's tolerance, the part itself.
job=$SAMPLES/jobs/wang2.json
fettle-part "$SAMPLES/parts/wang2.json" -o part.stl
fettle-part "$SAMPLES/parts/wang2.json" --without-anomaly -o truth.stl
sample=(fettle-sample "$job" --on part.stl --noise normal:0.005 --ascii)
rows() { sed '1,/^DATA/d' "$1"; }
"${sample[@]}" --report report.json >samples.pcd
"${sample[@]}" --strategy wang >wang.pcd
"${sample[@]}" --threads 1 | cmp samples.pcd -
cmp <(rows wang.pcd) <(rows samples.pcd | head -n 7)
jq -e --argjson tolerance "$(jq .tolerance "$job")" '.layout_touches == 7 and .touches > 7 and .touches <= 30 and .within_tolerance and
    .predicted_band <= $tolerance and (.predicted_bands | length) == .touches and .predicted_bands[6] > $tolerance' report.json
rows samples.pcd | tail -n +8 | awk '$1 < 0.0999 || $1 > 2.9001 || $2 < 0.0999 || $2 > 2.9001 || $4 != -1 { exit 1 }'
fettle-fit "$job" samples.pcd | fettle-mesh --step 0.05 --within "$job" |
    fettle-compare --to truth.stl --mode z --within "$job" --report band.json -o /dev/null || [ $? -eq 1 ]
jq -e --slurpfile report report.json '.regions.inside.band <= $report[0].predicted_band' band.json

"${sample[@]}" --max-touches 9 --report few.json -o few.pcd 2>warning
grep -q '9 touches leave a predicted error band' warning
jq -e '.touches == 9 and .within_tolerance == false' few.json
jq '.tolerance = 0.05' "$job" >rough.json
fettle-sample rough.json --on part.stl --noise normal:0.005 --ascii --report rough-report.json | rows /dev/stdin | cmp <(rows wang.pcd) -
jq -e '.touches == 7 and .within_tolerance' rough-report.json
# A sinusoidal roughness that no touch predicts: more touches than a few batches of eight do not help, and are not made.
awk 'BEGIN { for (x = -40; x <= 40; x += 0.5) for (y = -40; y <= 40; y += 0.5) print x, y, 0.3 * sin(2 * x) * sin(2.3 * y + 1) }' >wavy.xyz
jq '.units.length = "mm" | .anomaly = [[-15, -15, 0], [15, -15, 0], [15, 15, 0], [-15, 15, 0]] | .sampling = [[-32, -32, 0], [32, -32, 0], [32, 32, 0], [-32, 32, 0]] |
    .surface = {type: "freeform"} | .tolerance = 0.05 | .probe.accuracy = 0.05 | .safe_height = 20' "$job" >wavy.json
fettle-sample wavy.json --on wavy.xyz --report wavy-report.json -o wavy.pcd 2>warning
grep -q 'more than the tolerance' warning
jq -e '.layout_touches < .touches and .touches < 60 and .within_tolerance == false' wavy-report.json
