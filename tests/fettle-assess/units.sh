# Surfels in inches or metres are judged as the same in mm: what comes out is in mm. Reference: each other.
cat > plate.json <<'JSON'
{"kind": "patches", "units": {"length": "mm"}, "patches": [{"degree": [1, 1], "knots_u": [0, 0, 10, 10], "knots_v": [0, 0, 6, 6],
  "control": [[[0, 0, 0], [0, 6, 0]], [[10, 0, 0], [10, 6, 0]]]}]}
JSON
printf 'OFF\n4 1 0\n-1 -1 -0.5\n11 -1 1.9\n11 7 4.3\n-1 7 1.9\n4 0 1 2 3\n' > slope.off
fettle-surfel plate.json --stock slope.off --spacing 0.5 | fettle-assess --lower -1 --upper 2 --report mm.json > mm.pcd || [ $? = 1 ]
fettle-surfel plate.json --stock slope.off --spacing 0.5 --ascii > surfels.pcd
# the points of a path over them likewise
path() { fettle-path "$1" --spacing 0.9 --step-over 1.7 --ascii | sed '1,/^DATA/d' | cut -d' ' -f1-3; }
path surfels.pcd > mm.path
for unit in in m; do
    case $unit in in) mm=25.4 ;; m) mm=1000 ;; esac
    awk -v mm=$mm -v unit=$unit '/^# units/ { $3 = unit } body { $1 /= mm; $2 /= mm; $3 /= mm; $7 /= mm; $11 /= mm * mm; $12 /= mm }
        /^DATA/ { body = 1 } { print }' CONVFMT=%.17g OFMT=%.17g surfels.pcd > $unit.pcd
    fettle-assess $unit.pcd --lower -1 --upper 2 --report $unit.json > judged.pcd || [ $? = 1 ]
    fettle-diff --tol 1e-5 judged.pcd mm.pcd
    jq -e --slurpfile b mm.json '.gouge == $b[0].gouge and .undercut == $b[0].undercut and .undercut > 10 and .count == $b[0].count' $unit.json > ok
    path $unit.pcd | paste -d' ' - mm.path | awk '($1 - $4) ^ 2 + ($2 - $5) ^ 2 + ($3 - $6) ^ 2 > 1e-8 { exit 1 }'
done
