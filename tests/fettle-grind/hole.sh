# A scan with a hole under the anomaly: fettle-sample touches beside it, fettle-grind refuses it and names the place, by the cells that it
# would take by itself, too, in 2 s of processor time.
# shellcheck source=tests/fettle-grind/stock.bash
. "$HERE/stock.bash"
make_job 0
awk 'BEGIN { for (i = -80; i <= 80; i++) for (j = -80; j <= 80; j++) if (i * i + j * j > 36 * 4) print i / 4, j / 4, 5 }' >hole.xyz
jq '.anomaly |= map(. + [5])' job.json >taught.json
fettle-sample taught.json --on hole.xyz --ascii >samples.pcd
! grep -qi nan samples.pcd || exit 1
"$HERE/../refuses" 'hole.xyz: no surface over ' fettle-grind plan.json --stock hole.xyz --cell 0.25
(ulimit -t $((2 * ${FETTLE_PATIENCE:-1})) && "$HERE/../refuses" 'hole.xyz: no surface over ' fettle-grind plan.json --stock hole.xyz)
