# One set of touches gives one surface: in a job in inches, in one in millimetres, and as millimetres read into the job in inches.
# Reference: each other.
source "$HERE/points.bash"
job freeform | sed 's/1e-4/0.005/' >in.json
jq '.units.length = "mm" | .probe.accuracy *= 25.4 | (.anomaly, .sampling) |= map(map(. * 25.4))' in.json >mm.json
formula='0.2 * sin(3 * x) + 0.3 * y ^ 2'
heights "$formula" 20 1 | touches >in.pcd
heights "$formula" 20 1 | awk '{ printf "%.9f %.9f %.9f\n", 25.4 * $1, 25.4 * $2, 25.4 * $3 }' | touches | sed 1d >mm.pcd
fettle-fit in.json in.pcd >in.surface
fettle-fit mm.json mm.pcd >mm.surface
fettle-fit in.json mm.pcd --file-units mm >read.surface
fettle-mesh in.surface --step 0.2 --within in.json --sigma >in.grid
fettle-mesh read.surface --step 0.2 --within in.json --sigma | fettle-diff --tol 1e-5 in.grid -
# the grid in the units of the job it is given
fettle-mesh mm.surface --step 0.2 --within in.json --sigma | fettle-diff --tol 1e-5 in.grid -
