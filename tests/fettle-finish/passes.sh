# On a plane passes for ridges of height s lie 2√(2 r s - s²) apart, or less to fill the width; every move is one straight line,
# and the cutter runs on the plane. Along 30 degrees the tip stays on it, too, but where beyond a border only the corner (of
# 1 mm) touches. Reference: the geometry of a ball.
printf 'OFF\n4 1 0\n0 0 5\n40 0 5\n40 30 5\n0 30 5\n4 0 1 2 3\n' > plane.off
fettle-finish plane.off --cutter ball:6 --scallop 0.01 --pcd --ascii --report report.json > path.pcd
jq -e '(.step_over - 2 * (0.0599 | sqrt) | fabs) < 1e-9 and .overhang == 0' report.json > ok
# 30 / 0.489 = 61.3: 63 passes, two points each and two rapid ones
awk '/^DATA/ { body = 1; next } body { n++; if ($4 > 0 ? $3 != 5 : $3 != 10) bad++ } END { exit bad > 0 || n != 128 }' path.pcd
fettle-finish plane.off --cutter bull:6,1 --step-over 2 --angle 30 --allowance 0.5 > turned.nc
grep -c '^G0' turned.nc
awk '/^[GXYZ]/ { for (i = 1; i <= NF; i++) { if ($i ~ /^G[01]$/) g = $i; if ($i ~ /^Z/) z = substr($i, 2) } if (g == "G1" && (z > 5.5 || z < 4.5)) exit 1 }' turned.nc
