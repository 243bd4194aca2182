# The statistics of 1,001 surfels with displacements of no order. Reference: the sums of the same numbers, by awk; the extremes and the median
# from sort. 1e-12 is the rounding of the sums.
awk 'BEGIN { n = 1001
    printf "VERSION .7\nFIELDS x y z normal_x normal_y normal_z displacement\nSIZE 4 4 4 4 4 4 8\nTYPE F F F F F F F\nCOUNT 1 1 1 1 1 1 1\nWIDTH %d\nHEIGHT 1\nPOINTS %d\nDATA ascii\n", n, n
    for (s = 1; i < n; ++i) { s = (16807 * s) % 2147483647; printf "%d 0 0 0 0 1 %.17g\n", i, s / 2147483647 - 0.4 } }' > work.pcd
fettle-assess work.pcd --lower -0.1 --upper 0.2 --report report.json > errors.pcd && exit 1
sed '1,/^DATA/d' work.pcd | cut -d ' ' -f 7 | sort -g |
    awk '{ d[NR] = $1; sum += $1; abs += $1 < 0 ? -$1 : $1; squares += $1 * $1; gouge += $1 < -0.1; undercut += $1 > 0.2 }
         END { printf "{\"count\": %d, \"mean\": %.17g, \"mean_abs\": %.17g, \"rms\": %.17g, \"min\": %.17g, \"max\": %.17g, \"p50\": %.17g, \"within\": %.17g, \"gouge\": %d, \"undercut\": %d}\n",
             NR, sum / NR, abs / NR, sqrt(squares / NR), d[1], d[NR], d[501], 1 - (gouge + undercut) / NR, gouge, undercut }' > expected.json
jq '{count, mean, mean_abs, rms, min, max, p50, within, gouge, undercut}' report.json | fettle-diff - expected.json --tol 1e-12
