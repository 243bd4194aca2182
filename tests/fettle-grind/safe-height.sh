# A stock that stands as high as the safe height, at which the wheel travels, is refused with both heights; one that stands just
# below it is not. By hand likewise. Reference: a plane at z = 5 mm with a hill, and a safe height of 20 mm.
# shellcheck source=tests/fettle-grind/stock.bash
. "$HERE/stock.bash"
make_job 0
make_stock 16
"$HERE/../refuses" 'stock.stl: stands at z 20.9946, not below safe_height 20: the wheel would travel through it' fettle-grind plan.json --stock stock.stl
jq '.safe_height = 21.1' job.json | fettle-plan - surface.json |
    jq '.bounds.time = 1' | fettle-grind --stock stock.stl -q > ground.pcd || [ $? = 1 ]
[ -s ground.pcd ]
jq '.sampling = [[-15, -15], [15, -15], [15, 15], [-15, 15]]' job.json > manual.json
"$HERE/../refuses" 'stock.stl: stands at z 20.99' fettle-manual manual.json --stock stock.stl --machine "$SAMPLES/machines/full_scale.json" \
    --steer "$SAMPLES/steering/h.txt"
