# A robot grinds as the gantry does, with each way of grinding layer 1: the same trace and the same part, byte for byte, from an arm that nowhere leaves the
# range of a joint, and whose tip is where the trace says. References: the gantry; fettle-arm's forward kinematics of the joints that moved.
# shellcheck source=tests/fettle-gantry-robot/stock.bash
. "$HERE/stock.bash"
make_job 30
make_stock 2
make_place 25
for layer_1 in constant feed force; do
    fettle-grind plan.json --stock stock.stl --cell 0.2 --layer-1 $layer_1 --trace gantry.pcd \
        --gantry 'exec:fettle-gantry-virtual plan.json --stock stock.stl --cell 0.2 --ground gantry-ground.pcd' > gantry-known.pcd
    fettle-grind plan.json --stock stock.stl --cell 0.2 --layer-1 $layer_1 --trace robot.pcd --place place.txt --report grind.json \
        --gantry "exec:fettle-gantry-robot $ROBOT plan.json --stock stock.stl --cell 0.2 --ground robot-ground.pcd --moves moves.pcd --report moves.json" > robot-known.pcd
    jq -e .finished grind.json > ok
    cmp gantry.pcd <(without_place robot.pcd)
    cmp gantry-ground.pcd robot-ground.pcd
    cmp gantry-known.pcd robot-known.pcd
    jq -e '.count > 500 and .reached == .count and .jumps == [] and .min_singularity > 0.05' moves.json > ok || { cat moves.json; exit 1; }
done

# The tip stands where the joints bring it, by kinematics of their own, and back in the job's frame where the trace says that the drives were.
fettle-arm "$ROBOT" --forward moves.pcd -q -o forward.csv
fettle-place moves.pcd --matrix place.txt --inverse back.txt -q -o twice.csv 2> warning
fettle-place forward.csv --matrix back.txt -q -o job.csv 2> warning
fettle-place robot.pcd -q -o trace.csv
awk -F , '
    FNR == 1 { split("", c); for (i = 1; i <= NF; ++i) c[$i] = i; next }
    { key = sprintf("%.6f", $c["t"]) }
    FILENAME == "job.csv" { at[key] = $c["x"] " " $c["y"] " " $c["z"]; next }
    $c["feed"] > 0 {
        if (!(key in at)) exit 1
        split(at[key], p, " ")
        if (($c["x"] - p[1]) ^ 2 + ($c["y"] - p[2]) ^ 2 + ($c["z"] - $c["deflection"] - p[3]) ^ 2 > 0.001 ^ 2) exit 1
        ++n
    }
    END { exit n < 200 }' job.csv trace.csv
