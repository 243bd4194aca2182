# Touches chosen one after the other on Wang's part 3: they lie in S \ B, stop within the job's tolerance, follow the seed
# and not the threads, pass through fettle-estimate, and the fit to them is within its predicted band of the truth.
job=$SAMPLES/jobs/wang3.json
fettle-part "$SAMPLES/parts/wang3.json" -o part.stl
fettle-part "$SAMPLES/parts/wang3.json" --without-anomaly -o truth.stl
sample=(fettle-sample "$job" --on part.stl --strategy adaptive --noise normal:0.005)
"${sample[@]}" --report report.json --ascii >samples.pcd
"${sample[@]}" --ascii --threads 1 | cmp samples.pcd -
! "${sample[@]}" --ascii --seed 2 | cmp -s samples.pcd - || exit 1
jq -e --argjson tolerance "$(jq .tolerance "$job")" \
    '.within_tolerance and .predicted_band <= $tolerance and .touches >= 8 and .touches <= 20' report.json
# S: 0.1 to 2.9 in
grep '^DATA' -A 99 samples.pcd | tail -n +2 | awk '
    $1 < 0.0999 || $1 > 2.9001 || $2 < 0.0999 || $2 > 2.9001 { exit 1 }
    $4 != -1 || ($5 != 1 && $5 != 2) { exit 1 }'
fettle-estimate "$job" samples.pcd | fettle-fit "$job" | fettle-mesh --step 0.05 --within "$job" |
    fettle-compare --to truth.stl --mode z --within "$job" --report band.json -o /dev/null || [ $? -eq 1 ]
jq -e --slurpfile report report.json '.regions.inside.band <= $report[0].predicted_band' band.json

# More touches than allowed would be needed: a warning, and what there is.
"${sample[@]}" --max-touches 8 --report few.json -o few.pcd 2>warning || exit 1
jq -e '.touches == 8' few.json
# A scan with a hole beside the anomaly: the place is named, and touched elsewhere.
jq '.sampling = [[-0.4, 0.1], [2.9, 0.1], [2.9, 2.9], [-0.4, 2.9]]' "$job" >beyond.json
fettle-sample beyond.json --on part.stl --strategy adaptive --noise normal:0.005 --report beyond-report.json -o beyond.pcd 2>warning
grep -q 'part.stl: no surface at (-0.' warning
jq -e '.within_tolerance' beyond-report.json

refuses=$HERE/../refuses
"$refuses" '--strategy adaptive needs a part to touch: --on SURFACE' fettle-sample "$job" --strategy adaptive
"$refuses" '--max-touches' fettle-sample "$job" --on part.stl --strategy adaptive --max-touches 3
jq 'del(.sampling) | .surface.type = "plane"' "$job" >plane.json
"$refuses" 'plane.json: touching adaptively needs a sampling boundary' fettle-sample plane.json --on part.stl --strategy adaptive
