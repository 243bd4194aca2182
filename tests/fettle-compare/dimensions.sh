# Every number of the reports and every field of the error maps scales as its dimension: the same part in mm, in and m.
mm_per() { case $1 in mm) echo 1 ;; in) echo 25.4 ;; m) echo 1000 ;; esac; }
powers='{"count": 0, "undefined": 0, "mean": 1, "mean_abs": 1, "rms": 1, "sd": 1, "min": 1, "max": 1, "band": 1, "p01": 1, "p05": 1, "p50": 1,
    "p95": 1, "p99": 1, "within": 0, "over_cut_area": 2, "under_cut_area": 2, "over_cut_volume": 3, "under_cut_volume": 3, "min_at": 1,
    "max_at": 1, "limit": 1, "below": 0, "above": 0, "counts": 0, "reference_sigma": 1, "tolerance": 1, "worst": 1, "weld_tolerance": 1,
    "dropped_facets": 0, "unused_vertices": 0, "welded_vertices": 0, "repeated_facets": 0, "opposite_facets": 0, "flipped_facets": 0}'
fields='{"x": 1, "y": 1, "z": 1, "normal_x": 0, "normal_y": 0, "normal_z": 0, "error": 1, "foot_x": 1, "foot_y": 1, "foot_z": 1, "facet": 0,
    "region": 0, "sigma": 1, "rgb": 0}'
for unit in mm in m; do
    mm=$(mm_per $unit)
    mkdir $unit
    awk -v mm="$mm" 'BEGIN { for (i = 0; i <= 30; i++) for (j = 0; j <= 30; j++) printf "%.17g %.17g %.17g\n", i / mm, j / mm, (i * j / 90 + 0.02 * sin(7 * i + 5 * j)) / mm }' >$unit/reference.xyz
    awk -v mm="$mm" 'BEGIN { for (u = 3; u <= 33; u += 1.7) for (v = 3; v <= 27; v += 1.3) {
        i = u + 0.3 * sin(9 * u + 5 * v); j = v + 0.3 * cos(7 * u - 3 * v); printf "%.17g %.17g %.17g\n", i / mm, j / mm, (i * j / 90 + 0.3 * sin(i) * cos(j / 2) + 0.1) / mm } }' >$unit/test.xyz
    awk -v mm="$mm" 'BEGIN { split("0 0 0 30 0 1 30 30 12 0 30 0", v, " "); for (i = 1; i < 12; i += 3) printf "v %.17g %.17g %.17g\n", v[i] / mm, v[i + 1] / mm, v[i + 2] / mm; print "f 1 2 3\nf 1 4 3" }' >$unit/mesh.obj
    length_of() { awk -v l="$1" -v mm="$mm" 'BEGIN { printf "%.17g", l / mm }'; }
    jq -n --arg unit $unit --argjson mm "$mm" '{kind: "job", units: {length: $unit}, surface: {type: "freeform"}, tolerance: (0.25 / $mm),
        anomaly: [[8, 8], [20, 8], [20, 20], [8, 20]] | map(map(. / $mm)), sampling: [[5, 5], [25, 5], [25, 25], [5, 25]] | map(map(. / $mm))}' >$unit/job.json
    cd $unit
    units="--file-units $unit --to-units $unit --units $unit --ascii -q"
    for case in cloud mesh within; do
        [ $unit.$case != m.within ] || continue # jobs are in mm or in inches
        case $case in
            cloud) arguments="--to reference.xyz $units --fields foot,sigma --reverse reverse.pcd --max-distance $(length_of 1.5)" ;;
            mesh) arguments="--to mesh.obj $units --fields foot,facet --mode z --tolerance $(length_of 0.25)" ;;
            within) arguments="--to reference.xyz $units --fields region --within job.json" ;;
        esac
        fettle-compare test.xyz $arguments --report $case.json -o $case.pcd || [ $? -eq 1 ]
    done
    cd ..
done
for unit in in m; do
    for case in cloud mesh within; do
        [ $unit.$case != m.within ] || continue
        "$HERE/../scales" $unit "$powers" mm/$case.json $unit/$case.json
        "$HERE/../scales" $unit "$fields" mm/$case.pcd $unit/$case.pcd
    done
    "$HERE/../scales" $unit "$fields" mm/reverse.pcd $unit/reverse.pcd
done
