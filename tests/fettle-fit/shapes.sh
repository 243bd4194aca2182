# Exact touches of each shape, in inches, scattered. Reference: the generating formula at other places. Touches and
# heights are F4: 3e-6 in covers their rounding at 10 in. `auto` finds out
# which shape it is.
source "$HERE/points.bash"
check() { # METHOD GOT JOB FORMULA
    heights "$4" 24 1 | touches >touches.pcd
    fettle-fit --method "$1" "$3" touches.pcd --report report.json -o surface.json
    jq -e --arg got "$2" '.method == $got and .touches == 24 and .ignored == 0 and .rms < 2e-6' report.json
    heights "$4" 60 2 | pcd x y z >truth.pcd
    fettle-mesh surface.json --at truth.pcd | fettle-diff --tol 3e-6 truth.pcd -
}
job plane >plane.json
job swept ', "direction_deg": 30' >swept.json
job freeform >freeform.json
check auto plane plane.json '0.3 * x - 2 * y'
check auto swept swept.json '0.2 * (0.8660254 * x + 0.5 * y) + 0.5 * (-0.5 * x + 0.8660254 * y) ^ 3 + 4'
check bspline bspline freeform.json '1 + 0.2 * x ^ 2 - 0.1 * x * y - 0.3 * y ^ 2'
check auto quadratic freeform.json '1 + 0.2 * x ^ 2 - 0.1 * x * y - 0.3 * y ^ 2'
check auto sphere freeform.json '7 + sqrt(16 - (x - 0.2) ^ 2 - (y + 0.1) ^ 2)'
check sphere sphere freeform.json '7 + sqrt(16 - (x - 0.2) ^ 2 - (y + 0.1) ^ 2)'
check sphere sphere freeform.json '7 - sqrt(16 - (x - 0.2) ^ 2 - (y + 0.1) ^ 2)'
check sphere sphere freeform.json '7 + 0.2 * x' # flat: no radius without bounds
check cylinder cylinder freeform.json '7 - sqrt(16 - (0.6 * x + 0.8 * y) ^ 2)'
check cylinder cylinder freeform.json '7 + sqrt(16 - (0.6 * x + 0.8 * y) ^ 2)'
check auto cylinder freeform.json '7 + sqrt(16 - (0.6 * x + 0.8 * y) ^ 2)'
# a cone about the x axis, half-angle atan 0.5; a torus about the z axis: ring 6, tube 4, seen near its top
check cone cone freeform.json 'sqrt((5 + 0.5 * x) ^ 2 - y ^ 2)'
check torus torus freeform.json 'sqrt(16 - (sqrt((x + 6) ^ 2 + y ^ 2) - 6) ^ 2)'
# an ellipsoid with semi-axes 5, 7 and 4, its longest turned by 37 degrees from the y axis
check quadric quadric freeform.json '4 * sqrt(1 - ((0.8 * x + 0.6 * y) / 5) ^ 2 - ((0.8 * y - 0.6 * x) / 7) ^ 2)'
check auto cubic freeform.json '1 + 0.2 * x ^ 2 - 0.1 * x * y - 0.3 * y ^ 2 + 0.1 * x ^ 3 - 0.2 * x * y ^ 2'
