# Every field of the ground part and of the trace, and every key of the report, scales as its dimension when the same work is
# done in inches and pounds; the stock is the same file, in mm, or in m. Reference: 1 in = 25.4 mm, 1 lbf = 4.4482216152605 N.
# shellcheck source=tests/fettle-grind/stock.bash
. "$HERE/stock.bash"
# shellcheck source=tests/fettle-grind/dimensions.bash
. "$HERE/dimensions.bash"
make_job 30
make_stock 2
inch_job
jq '.units.length = "in" | .shape.z0 /= 25.4' surface.json > in-surface.json
fettle-plan in-job.json in-surface.json > in-plan.json
jq '.units.length = "m" | .surface.point |= map(. / 1000) | .region |= map_values(map(. / 1000)) | .step /= 1000 |
    .anomalies |= map(.centre |= map(. / 1000) | .semi_axes |= map(. / 1000) | .height /= 1000)' part.json > m-part.json
fettle-part m-part.json > m-stock.stl
fettle-grind plan.json --stock stock.stl --cell 0.2 --report mm.json --trace mm-trace.pcd --ascii > mm.pcd
fettle-grind in-plan.json --stock stock.stl --stock-units mm --cell "$(jq -n '0.2 / 25.4')" --report in.json --trace in-trace.pcd --ascii > in.pcd
fettle-grind plan.json --stock m-stock.stl --stock-units m --cell 0.2 --report m.json --ascii > m.pcd
"$HERE/../scales" in,lbf "$dimensions" mm.pcd in.pcd 1e-6
"$HERE/../scales" in,lbf "$dimensions" mm-trace.pcd in-trace.pcd 1e-5
"$HERE/../scales" in,lbf "$dimensions" mm.json in.json 1e-6
fettle-diff --tol 1e-5 mm.pcd m.pcd
