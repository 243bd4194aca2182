# A hill that reaches beyond B: nothing is removed outside B beyond the wheel's own footprint. The wheel lies flush with
# the sides of B along its axis; in its plane it reaches √(R² - (R - h)²) = 6.0 mm over stock h = 2 mm high.
# shellcheck source=tests/fettle-grind/stock.bash
. "$HERE/stock.bash"
for theta in 0 30; do
    make_job $theta
    jq '.anomalies[0] = {type: "hill", centre: [0, 0], semi_axes: [14, 14], height: 2}' <(make_stock 1; cat part.json) |
        fettle-part > stock.stl
    fettle-grind plan.json --stock stock.stl --ascii |
        awk -v theta=$theta 'BEGIN { a = theta * 3.141592653589793 / 180 }
            /^DATA/ { body = 1; next }
            body && $4 > 1e-6 { x = $1 * cos(a) + $2 * sin(a); y = $2 * cos(a) - $1 * sin(a)
                                if (x < 0) x = -x; if (y < 0) y = -y
                                if (x > 6 || y > 12) { print; bad++ }; if (y > 6.5) n++ }
            END { exit bad > 0 || n == 0 }'
done
