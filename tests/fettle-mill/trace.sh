# The trace has a point for each move: where it ends, when, and what it met. A flat cutter of 10 mm goes 20 mm through a
# block, 2 mm deep, then back through the air of its slot: it removes 20·10·2 mm³ and half its disc, then nothing. The
# volumes of all moves are what the stock loses. Reference: geometry; the cells' 0.1 mm at the rim of a disc.
printf 'G0 X-10 Y15 Z-2\nG1 X10 F600\nX30\nX10 F1200\nG0 Z5\n' > slot.nc
fettle-mill slot.nc --stock box:0,0,-10,40,30,0 --cutter flat:10 --step 0.1 --trace trace.pcd --ascii --report report.json --rapid 100 -o part.stl
awk '/^DATA/ { body = 1; next } body { n++; move[n] = $0 } function near(a, b, tolerance) { return a - b < tolerance && b - a < tolerance }
    END { # x y z t feed removed volume holder place
        split(move[2], first); split(move[3], second); split(move[4], back); split(move[5], lift)
        exit !(n == 5 && first[1] == 10 && first[3] == -2 && first[4] == 2 && first[5] == 10 && first[9] == 2 && near(first[6], 2, 1e-6) &&
            near(first[7] + second[7], 2 * (30 * 10 + 3.14159265 * 25 / 2), 4) && back[6] == 0 && back[7] == 0 && back[4] == 5 &&
            near(lift[4], 5.07, 1e-9) && lift[5] == 100 && lift[9] == 5) }' trace.pcd
awk '/^DATA/ { body = 1; next } body { sum += $7 } END { printf "%.6f\n", sum }' trace.pcd > sum
jq -e --slurpfile sum sum '(.removed_volume / $sum[0] - 1 | fabs) < 1e-6' report.json > ok
