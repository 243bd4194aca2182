# The best 16 of about 90 places on a known patch: they lie in S \ B, follow the seed and not the threads, and their
# band is smaller than that of the start and of Wang's layout. Reference: the chain itself (fettle-fit, fettle-mesh,
# fettle-compare) finds the reported band; its grid and the mesh's facets explain 1e-3 in. Bad inputs are refused.
job=$SAMPLES/jobs/patch_convex_2x2.json
fettle-part "$SAMPLES/parts/patch_convex_2x2.json" --without-anomaly -o truth.stl
search=(fettle-sample "$job" --on truth.stl --strategy hillclimb)
climb() { "${search[@]}" --candidates 0.45 --mutations 60 "$@"; }
climb --report report.json --ascii >best.pcd
climb --ascii --threads 1 | cmp best.pcd -
! climb --ascii --seed 2 | cmp -s best.pcd - || exit 1
jq -e '.touches == 16 and .candidates > 60 and .candidates < 100 and .band < .start_band' report.json
grep '^DATA' -A 99 best.pcd | tail -n +2 | awk '
    $1 < 0.049 || $1 > 4.951 || $2 < 0.049 || $2 > 3.951 || ($1 > 1.501 && $1 < 3.499 && $2 > 1.001 && $2 < 2.999) { exit 1 }
    $4 != -1 || ($5 != 1 && $5 != 2) { exit 1 }'
# half the mean distance of 16 touches over 4.9 x 3.9 in
spacing=0.54639
band() { # SAMPLES
    fettle-fit "$job" "$1" --method griddata --spacing $spacing | fettle-mesh --step 0.05 --within "$job" |
        fettle-compare --to truth.stl --mode z --within "$job" --report band.json -o /dev/null || [ $? -eq 1 ]
    jq .regions.inside.band band.json
}
jq -e --argjson band "$(band best.pcd)" '.band - $band | fabs < 1e-3' report.json
fettle-sample "$job" --on truth.stl --strategy wang >wang.pcd
jq -e --argjson wang "$(band wang.pcd)" '.band < $wang / 2' report.json
climb --fit bspline-wang --touches 20 --report spline.json >/dev/null
jq -e '.touches == 20 and .band < .start_band' spline.json

refuses=$HERE/../refuses
"$refuses" 'patch_convex_2x2.json: --strategy hillclimb needs the surface: --on SURFACE' fettle-sample "$job" --strategy hillclimb
"$refuses" '--lines is for --strategy wang' "${search[@]}" --lines 2
"$refuses" 'truth.stl: there are 18 candidates for 21 touches' "${search[@]}" --candidates 1 --touches 21
"$refuses" 'truth.stl: a spacing of 0.001 in gives more than 100000 candidates' "${search[@]}" --candidates 0.001
"$refuses" '--strategy' fettle-sample "$job" --on truth.stl --strategy hill
"$refuses" '--touches, --candidates, --sharpness: only for --strategy hillclimb' fettle-sample "$job" --on truth.stl --touches 9
jq '.surface.type = "plane"' "$job" >plane.json
"$refuses" 'plane.json: --strategy hillclimb is for free-form jobs' fettle-sample plane.json --on truth.stl --strategy hillclimb
jq '.anomaly[2] = [4.2, 4.7] | .sampling[2] = [4.95, 5.4]' "$job" >beyond.json
"$refuses" 'truth.stl: no surface inside the anomaly at (4.2, 4.7) in' fettle-sample beyond.json --on truth.stl --strategy hillclimb
# of two rows of places no three cover the anomaly
"$refuses" 'truth.stl: no subset of the candidates that was tried covers the anomaly' "${search[@]}" --touches 3 --candidates 2.1
