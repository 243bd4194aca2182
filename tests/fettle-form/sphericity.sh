# Six points on a sphere of radius 10.25 along the axes and eight on one of 9.75 along the diagonals, about (1, 2, 3):
# by symmetry the minimum zone is 0.5 wide and its middle the centre.
awk 'BEGIN { r = 9.75 / sqrt(3)
    for (s = -1; s <= 1; s += 2) { print 1 + 10.25 * s, 2, 3; print 1, 2 + 10.25 * s, 3; print 1, 2, 3 + 10.25 * s
        for (t = -1; t <= 1; t += 2) for (u = -1; u <= 1; u += 2) printf "%.9g %.9g %.9g\n", 1 + r * s, 2 + r * t, 3 + r * u } }' |
    fettle-form sphericity >form.json
jq -e '(.minimum_zone - 0.5 | fabs) < 1e-8 and (.elements.minimum_zone.radius - 10 | fabs) < 1e-8 and
    (.elements.least_squares.centre[2] - 3 | fabs) < 1e-8' form.json >/dev/null
