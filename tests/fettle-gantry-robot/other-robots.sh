# Robots as their makers describe them carry the wheel too, with a spherical wrist or three parallel axes, and one whose part lies on a table, turned: the gantry's trace, within the
# ranges and the speeds of their joints, and tips where their joints bring them. References: the gantry; the files, by fettle-arm.
# shellcheck source=tests/fettle-gantry-robot/stock.bash
. "$HERE/stock.bash"
make_job 20
make_stock 1
fettle-grind plan.json --stock stock.stl --cell 0.2 --gantry 'exec:fettle-gantry-virtual plan.json --stock stock.stl --cell 0.2' --trace gantry.pcd > ground.pcd
while read -r robot x y z; do
    printf '1 0 0 %s\n0 1 0 %s\n0 0 1 %s\n0 0 0 1\n' "$x" "$y" "$z" > place.txt
    fettle-grind plan.json --stock stock.stl --cell 0.2 --place place.txt --trace robot.pcd \
        --gantry "exec:fettle-gantry-robot -q $SAMPLES/robots/$robot plan.json --stock stock.stl --cell 0.2 --moves moves.csv" > ground.pcd
    cmp gantry.pcd <(without_place robot.pcd)
    fettle-arm "$SAMPLES/robots/$robot" --forward moves.csv --report judged.json -q -o forward.csv
    jq -e '.count > 500 and .reached == .count and .jumps == [] and ([.joints[].too_fast] | add) == 0' judged.json > ok || { cat judged.json; exit 1; }
    paste -d , <(cut -d , -f 1-7 moves.csv) <(cut -d , -f 1-7 forward.csv) |
        awk -F , 'NR > 1 { for (i = 1; i <= 7; ++i) if (($i - $(i + 7)) ^ 2 > 0.001 ^ 2) exit 1 } END { exit NR < 500 }'
done << 'END'
urdf/ur5.urdf 450 100 300
urdf/motoman_mh5.urdf 450 100 300
urdf/staubli_rx160.urdf 1000 100 650
irb1400_table.json 1000 1200 650
END
