# Which points a fit takes: touches (1, 2, 4, 5); estimated points (3) never; corners of the anomaly (0) for planes or
# on request. Those of the wrong role lie 1 in off here. Points without a height are left out. Reference: the formula.
source "$HERE/points.bash"
job freeform >freeform.json
job plane >plane.json
{
    heights 5+0.1*x 20 1 | sed 's/$/ 1/'
    heights 6+0.1*x 5 2 | sed 's/$/ 3/'
    echo '0.5 0.5 nan 2'
} >samples
heights 6+0.1*x 4 3 | sed 's/$/ 0/' | cat samples - | pcd x y z role >off.pcd
heights 5+0.1*x 4 3 | sed 's/$/ 0/' | cat samples - | pcd x y z role >on.pcd
heights 5+0.1*x 30 4 | awk '$1 ^ 2 < 1 && $2 ^ 2 < 1' | pcd x y z >truth.pcd
fits() { # TOUCHES IGNORED ARGUMENTS
    fettle-fit "${@:3}" --report report.json -o surface.json
    jq -e --argjson touches "$1" --argjson ignored "$2" '.touches == $touches and .ignored == $ignored' report.json
    fettle-mesh surface.json --at truth.pcd | fettle-diff --tol 2e-6 truth.pcd -
}
fits 20 10 freeform.json off.pcd
fits 20 10 freeform.json off.pcd --method sphere
fits 24 6 freeform.json on.pcd --use-boundary
fits 24 6 plane.json on.pcd
