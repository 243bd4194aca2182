# A plane through touches of a paraboloid, nearly a sphere of 100 mm: the fit converges, and says how far off the touches are. Reference: the formula,
# whose heights span 25 mm here.
source "$HERE/points.bash"
job freeform | jq '.units.length = "mm" | .probe.accuracy = 0.127 | (.anomaly, .sampling) |= map(map(. * 25))' >job.json
for count in 16 30 60; do
    for seed in 1 2 3 4 5 6 7 8; do
        awk -v seed=$seed -v n=$count 'BEGIN { srand(seed); for (i = 0; i < n; ++i) {
            x = 100 * rand() - 50; y = 100 * rand() - 50; printf "%.6f %.6f %.6f\n", x, y, -(x * x + y * y) / 200 } }' |
            touches | sed 1d >touches.pcd
        fettle-fit job.json touches.pcd --method plane --report report.json >surface.json 2>message
        [ "$(wc -l <message)" -eq 1 ]
        grep -F 'touches.pcd: the touches lie' message
        jq -e '.rms > 1 and .rms < 12.5 and .max_abs < 25' report.json
    done
done
