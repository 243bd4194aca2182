# A scan without triangles: its points every mm on z = x²/100 are touched as a local quadratic, which is exact. Where it
# has a hole, the place is named. Reference: the formula.
cat > job.json <<'JOB'
{"kind": "job", "units": {"length": "mm"}, "surface": {"type": "freeform"},
 "anomaly": [[15, 15], [25, 15], [25, 25], [15, 25]], "sampling": [[5, 5], [35, 5], [35, 35], [5, 35]]}
JOB
awk 'BEGIN { for (x = 0; x <= 40; ++x) for (y = 0; y <= 40; ++y) print x, y, x * x / 100 }' > scan.xyz
fettle-sample job.json --on scan.xyz --ascii | grep '^DATA' -A 99 | tail -n 16 |
    awk '{ d = $3 - $1 * $1 / 100; if (d > 1e-5 || d < -1e-5) exit 1 }'
awk '($1 - 33)^2 + ($2 - 20)^2 > 25' scan.xyz > holed.xyz
"$HERE/../refuses" 'holed.xyz: 2 of 16 touches find no surface, at (35, 18.3333) mm, (35, 21.6667) mm' fettle-sample job.json --on holed.xyz
# At an edge of the scan, beyond which there is nothing, touches go elsewhere, all in S and outside of B.
awk '($1 - 35)^2 + ($2 - 20)^2 > 36' scan.xyz > edge.xyz
fettle-sample job.json --on edge.xyz --format csv -o edge.csv 2> said
grep -q 'edge.xyz: touches lie over an edge of the part; touched adaptively' said
awk -F , 'NR > 1 { d = $3 - $1 * $1 / 100; if (d > 1e-5 || d < -1e-5 || ($1 > 15 && $1 < 25 && $2 > 15 && $2 < 25)) exit 1 } END { exit NR < 12 }' edge.csv
"$HERE/../refuses" 'edge.xyz: 2 of 16 touches find no surface' fettle-sample job.json --on edge.xyz --strategy wang
