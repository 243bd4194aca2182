# The first position lies 3 mm inside the stock: the way down is guarded, and the strategy goes up, layer by layer (0.5 mm
# each), to the one whose force is in range; 15 N are 1.5 mm, so that is layer 4. No force beyond F_max is needed for it.
# The stock goes on beyond B and keeps the wheel up at B's edge: layer 1 ends at its bound, with status 1.
# shellcheck source=tests/fettle-grind/stock.bash
. "$HERE/stock.bash"
make_job 0
jq -n '{kind: "part", units: {length: "mm"}, surface: {type: "plane", point: [0, 0, 8]},
    region: {x: [-20, 20], y: [-20, 20]}, step: 0.5, anomalies: []}' | fettle-part > stock.stl
status=0
jq '.bounds.coverings = 5' plan.json | fettle-grind --stock stock.stl --trace trace.pcd --ascii > ground.pcd 2> message || status=$?
[ $status = 1 ]
cat message
awk '/^DATA/ { body = 1; next } body { print $5, $7, ($8 <= 15.000001) } body && $7 == 0 { exit }' trace.pcd
awk '/^DATA/ { body = 1; next } body && $3 < 5 - 0.005 { exit 1 }' ground.pcd
