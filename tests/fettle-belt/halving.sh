# Half the distance of the contact points and of the surfels changes what a wheel takes from beads of .3, 1, 3 and 6 mm by 2 % rms at most, and a ripple
# from surfel to surfel, .1 mm to and fro, is ground down to a fifth and less. Reference: the same bead and path, refined.
plate() { # SPACING HEIGHT RIPPLE: a bead along x, 28 x 28 mm of it; surfels stand on its border, or in the middle of squares that tile it
    awk -v d="$1" -v h="$2" -v ripple="$3" -v middle="${middle:-0}" 'BEGIN {
        n = int(28 / d + .5) + (middle ? 0 : 1)
        printf "VERSION 0.7\nFIELDS x y z normal_x normal_y normal_z displacement\nSIZE 4 4 4 4 4 4 8\nTYPE F F F F F F F\nCOUNT 1 1 1 1 1 1 1\n"
        printf "WIDTH %d\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS %d\nDATA ascii\n", n * n, n * n
        for (i = 0; i < n; i++) for (j = 0; j < n; j++) {
            y = (j + middle) * d - 14
            printf "%.6g %.6g 0 0 0 1 %.9g\n", (i + middle) * d - 14, y, h * exp(-(y / 3) ^ 2) + ripple * (i % 2 ? 1 : -1) } }'
}
path() { # SPACING
    awk -v d="$1" 'BEGIN {
        n = int(20 / d + .5) + 1
        printf "VERSION 0.7\nFIELDS x y z qw qx qy qz\nSIZE 4 4 4 4 4 4 4\nTYPE F F F F F F F\nCOUNT 1 1 1 1 1 1 1\n"
        printf "WIDTH %d\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS %d\nDATA ascii\n", n, n
        for (i = 0; i < n; i++) printf "%g 0 0 1 0 0 0\n", i * d - 10 }'
}
grind() { # SPACING OF SURFELS AND POINTS, HEIGHT, RIPPLE
    plate "$1" "$3" "$4" > plate.pcd
    path "$2" > path.pcd
    fettle-belt plate.pcd --path path.pcd --wheel "$SAMPLES/wheels/$wheel.json" --force 20 --feed 2 ${cells:+--cells $cells} -q --ascii
}
# Under the large wheel, as wide as the plate, the border counts: by the fitted law, squares of the same plate are compared with their quarters.
for case in {crowned,rubber}_preston:{0.3,1,3,6} crowned:0.3 rubber:{3,6} rubber:0.3:0.5; do
    IFS=: read -r wheel height middle <<<"$case"
    grind 0.7 1 $height 0 > coarse.pcd
    grind 0.35 0.5 $height 0 > fine.pcd
    # Away from the ends of the path, at the places of the coarse surfels.
    awk -v height=$height -v middle="${middle:-0}" -v min="$(case $case in rubber_preston:0.3) echo 0.3 ;; rubber:0.3*) echo 0.25 ;; *) echo 0.5 ;; esac)" '
        FNR == 1 { ++file }
        /^DATA/ { body[file] = 1; next }
        !body[file] || $1 > 7 || $1 < -7 { next }
        { place = middle ? int(($1 + 14) / 0.7) " " int(($2 + 14) / 0.7) : sprintf("%.3f %.3f", $1, $2) }
        file == 1 { removed[place] = $8; next }
        place in removed { fine[place] += $8; ++count[place]; if ($8 > max) max = $8 }
        END {
            for (place in fine) { mean = fine[place] / count[place]; sum += (removed[place] - mean) ^ 2; all += mean ^ 2; ++n }
            printf "%s mm: %.4f of up to %.2f mm\n", height, sqrt(sum / all), max; exit !(n >= 800 && max > min && sum / all <= 0.02 ^ 2) }' coarse.pcd fine.pcd
done
wheel=crowned_preston cells=68 middle=
grind 0.7 1 0 0.05 > ripple.pcd
# Second differences along x of the surfels under the middle of the wheel: 4 amplitudes each.
awk '/^DATA/ { body = 1; next } body && $2 > -1 && $2 < 1 && $1 > -7 && $1 < 7 { z[$2, n[$2]++] = $7; rows[$2] = 1 }
    END { for (y in rows) for (i = 1; i < n[y] - 1; i++) { a = z[y, i - 1] - 2 * z[y, i] + z[y, i + 1]; sum += a * a; ++m }
        printf "ripple: %.4f mm\n", sqrt(sum / m) / 4; exit !(m > 20 && sqrt(sum / m) / 4 < 0.01) }' ripple.pcd
