# Sourced by the cases: the plane with a hill of fettle-grind's cases, its plan, and a place for it on the bench of the wheel's cell, tilted.
# shellcheck source=tests/fettle-grind/stock.bash
. "$HERE/../fettle-grind/stock.bash"
ROBOT=$SAMPLES/robots/irb1400_wheel.json
make_place() { # ROLL_DEG: the part turned about x, 650 mm above the floor
    awk -v a="$1" 'BEGIN { a *= 3.141592653589793 / 180
        printf "1 0 0 1000\n0 %.17g %.17g 1000\n0 %.17g %.17g 650\n0 0 0 1\n", cos(a), -sin(a), sin(a), cos(a) }' > place.txt
}

# A trace without what its header says of where the job lay: a gantry is not told.
without_place() { LC_ALL=C sed '1,/^DATA/s/ --place:[^ ]*//' "$1"; }
