# Robots as their makers describe them carry the wheel too, with a spherical wrist or three parallel axes: the gantry's trace, within the ranges and the speeds of their joints.
# References: the gantry; the files, by fettle-arm.
# shellcheck source=tests/fettle-gantry-robot/stock.bash
. "$HERE/stock.bash"
make_job 20
make_stock 1
fettle-grind plan.json --stock stock.stl --cell 0.2 --gantry 'exec:fettle-gantry-virtual plan.json --stock stock.stl --cell 0.2' --trace gantry.pcd > ground.pcd
while read -r robot x z; do
    printf '1 0 0 %s\n0 1 0 100\n0 0 1 %s\n0 0 0 1\n' "$x" "$z" > place.txt
    urdf=$SAMPLES/robots/urdf/$robot.urdf
    fettle-grind plan.json --stock stock.stl --cell 0.2 --place place.txt --trace robot.pcd \
        --gantry "exec:fettle-gantry-robot -q $urdf plan.json --stock stock.stl --cell 0.2 --moves moves.pcd" > ground.pcd
    cmp gantry.pcd robot.pcd
    fettle-arm "$urdf" --forward moves.pcd --report judged.json -q -o forward.csv
    jq -e '.count > 500 and .reached == .count and .jumps == [] and ([.joints[].too_fast] | add) == 0' judged.json > ok || { cat judged.json; exit 1; }
done << 'END'
ur5 450 300
motoman_mh5 450 300
staubli_rx160 1000 650
END
