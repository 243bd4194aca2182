# What is no design, no stock and no spacing ends with status 2, one line that names it, and nothing on stdout; a stock that
# no ray meets with status 1.
# shellcheck source=tests/fettle-surfel/box.bash
. "$HERE/box.bash"
refused() { "$HERE/../refuses" "$@"; }
box 0 0 0 20 10 5 > box.off
box 0 0 90 20 10 95 > far.off
: > empty.stl
printf '1 2 3\n4 5 6\n' > points.xyz
patch() { # KEY VALUE in a patch with a trimming curve
    jq -n "{kind: \"patches\", units: {length: \"mm\"}, patches: [{degree: [1, 1], knots_u: [0, 0, 1, 1], knots_v: [0, 0, 1, 1],
        control: [[[0, 0, 1], [0, 1, 1]], [[1, 0, 1], [1, 1, 1]]],
        trim: [{degree: 1, knots: [0, 0, 1, 2, 2], control: [[0, 0], [1, 0], [0, 0]]} + {$1: $2}]}]}"
}
refused 'empty.stl: empty' fettle-surfel empty.stl --stock box.off
refused 'empty.stl: empty' fettle-surfel box.off --stock empty.stl
refused '--stock' fettle-surfel box.off
refused 'points.xyz: no fields normal_x' fettle-surfel points.xyz --stock box.off
refused '--spacing: must be positive, got 0' fettle-surfel box.off --stock box.off --spacing 0
refused 'box.off: patch 0: the spacing is too fine for its size: 2e+14 surfels, at most 5e+06' fettle-surfel box.off --stock box.off --spacing 1e-6
refused 'box.off: patch' fettle-surfel box.off --stock box.off --edge-spacing 1e-9
refused '--sharp' fettle-surfel box.off --stock box.off --sharp 120
refused '--precision' fettle-surfel points.xyz --stock box.off --precision 0.1
refused 'only one of DESIGN and --stock' fettle-surfel - --stock -
patch control '[[0, 0], [2, 0], [0, 0]]' > outside.json
refused 'patches[0].trim[0].control[1]: lies outside' fettle-surfel outside.json --stock box.off
patch control '[[0, 0], [1, 0], [0, 1]]' > open.json
refused 'patches[0].trim[0].control: is not closed' fettle-surfel open.json --stock box.off
patch knots '[0, 0, 1, 2]' > knots.json
refused 'patches[0].trim[0].knots' fettle-surfel knots.json --stock box.off
patch weights '[1, 0, 1]' > weights.json
refused 'patches[0].trim[0].weights: must be positive' fettle-surfel weights.json --stock box.off
status=0
fettle-surfel box.off --stock far.off -q > work.pcd || status=$?
test $status = 1
# A control point that has been moved by metres makes a patch of millions of surfels.
jq '.patches[0].control[1][1] = [2000, 3000, 1] | del(.patches[0].trim)' open.json > moved.json
refused 'moved.json: patch 0: the spacing is too fine for its size' fettle-surfel moved.json --stock box.off
