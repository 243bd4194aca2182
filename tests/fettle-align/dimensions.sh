# Every number of the report, the matrix and the points scale as their dimension: the same scan in mm, in and m.
mm_per() { case $1 in mm) echo 1 ;; in) echo 25.4 ;; m) echo 1000 ;; esac; }
powers='{"iterations": 0, "count": 0, "overlap": 0, "max_distance": 1, "mean": 1, "rms": 1, "sigma": 1, "median": 1, "p90": 1, "p95": 1, "max": 1,
    "misfit": 1, "sd.x": 1, "sd.y": 1, "sd.z": 1, "rx_deg": 0, "ry_deg": 0, "rz_deg": 0, "determined": 0, "centre": 1, "radius": 1,
    "degrees_of_freedom.shift": 0, "degrees_of_freedom.turn": 0, "degrees_of_freedom.sd": 1, "next.turn_deg": 0, "next.shift": 1,
    "dropped": 0, "turns": 0, "shifts": 1}'
for unit in mm in m; do
    mkdir $unit
    awk -v mm="$(mm_per $unit)" 'BEGIN { for (i = 0; i < 40; i++) for (j = 0; j < 30; j++) {
        z = 4 * sin(i / 6) + 3 * cos(j / 5 + 1) + i * j / 100; e = 0.05 * sin(9 * i + 7 * j)
        printf "%.17g %.17g %.17g\n", i / mm, j / mm, z / mm >"'$unit'/waves.xyz"
        printf "%.17g %.17g %.17g\n", (7 - j) / mm, (i - 3) / mm, (z + e + 20) / mm >"'$unit'/turned.xyz" } }'
    cd $unit
    fettle-align turned.xyz --to waves.xyz --file-units $unit --to-units $unit --report all.json --ascii -q -o back.pcd
    # the matrix has turns and shifts
    jq '. + {turns: (.transform | map(.[:3])), shifts: (.transform | map(.[3])[:3])} | del(.transform, .next.transform)' all.json >report.json
    cd ..
done
for unit in in m; do
    "$HERE/../scales" $unit "$powers" mm/report.json $unit/report.json
    "$HERE/../scales" $unit '{"x": 1, "y": 1, "z": 1}' mm/back.pcd $unit/back.pcd
done
