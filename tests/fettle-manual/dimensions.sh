# Every field of the ground part and of the trace, and every key of the report, scales as its dimension when the same is done in
# inches and pounds. Reference: 1 in = 25.4 mm, 1 lbf = 4.4482216152605 N; the transducer's steps and the rounding of the trace stay.
# shellcheck source=tests/fettle-grind/stock.bash
. "$HERE/../fettle-grind/stock.bash"
# shellcheck source=tests/fettle-grind/dimensions.bash
. "$HERE/../fettle-grind/dimensions.bash"
make_job 0
make_stock 4
inch_job
printf '0 -1 0 up\n0.1 0 1\n0.4 0 -1\n0.6 0 0\n0.7 end\n' > steer.txt
manual() { fettle-manual "$1" --stock stock.stl --stock-units mm --machine "$SAMPLES/machines/full_scale.json" --steer steer.txt --ascii "${@:2}"; }
manual job.json --cell 0.2 --lowest 4 --report mm.json --trace mm-trace.pcd > mm.pcd
manual in-job.json --cell "$(jq -n '0.2 / 25.4')" --lowest "$(jq -n '4 / 25.4')" --report in.json --trace in-trace.pcd > in.pcd
"$HERE/../scales" in,lbf "$dimensions" mm.pcd in.pcd 1e-3
"$HERE/../scales" in,lbf "$dimensions" mm-trace.pcd in-trace.pcd 1e-3
"$HERE/../scales" in,lbf "$dimensions" mm.json in.json 1e-3
