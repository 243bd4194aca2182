# Sourced by the cases: the hill and the job of fettle-grind's cases, and an operator who shows a square of 14 mm around it.
# shellcheck source=tests/fettle-grind/stock.bash
. "$HERE/../fettle-grind/stock.bash"
machine=$SAMPLES/machines/full_scale.json
show() { # [FIRST]: lines of steering: the corners from that number on, from the middle of the part at 20 mm/s, then the touches; no start yet
    awk -v first="${1:-1}" 'BEGIN {
        n = split("-7 -7 7 -7 7 7 -7 7", c, " ") / 2
        for (i = first; i <= n; ++i) {
            dx = c[2 * i - 1] - x; dy = c[2 * i] - y
            printf "%.6f %g %g\n", t, dx, dy
            t += sqrt(dx * dx + dy * dy) / 20; x += dx; y += dy
            printf "%.6f record\n", t }
        printf "%.6f next\n%.6f next\n%.6f start\n", t, t, t }'
}
become_station() { # FOLDER STEERING OPTION…: in the background it has the number of the shell's $!
    exec fettle-station job.json --session "$1" --steer "$2" --stock stock.stl --cell 0.2 --lowest 0 --ascii "${@:3}"
}
station() { (become_station "$@"); }
rows() { # TRACE: that the header counts
    awk '/^POINTS/ { n = $2 } body && n-- > 0 { sub(/ *$/, ""); print } /^DATA/ { body = 1 }' "$1"
}
is_flat() { # SHIFT FILE: ground to the plane raised by SHIFT: within the tolerance of 0.1, and no more than 0.01 below the plane itself
    awk -v shift_="$1" '/^DATA/ { body = 1; next } body && $1 > -6 && $1 < 6 && $2 > -6 && $2 < 6 { if ($3 > 5.1 + shift_ || $3 < 5 - 0.01) bad++; n++ }
        END { if (bad || n != 3600) print bad " of " n " are not within"; exit bad > 0 || n != 3600 }' "$2"
}
ends_with() { # STATUS COMMAND…: its messages are in `said`
    local status=0
    "${@:2}" 2> said || status=$?
    [ $status = "$1" ] || { echo "status $status: $(cat said)"; exit 1; }
}
