# Preston's law is linear in force and speed: with twice the force, or a belt of twice the speed, the best constant feed is twice as high, and to
# leave half of the allowance it is twice as high again. Reference: the identity. Twice the force widens the contact, which
# reaches farther beyond the rim of the rows: 3 %. The constant is searched for; 1e-3 is where the search ends.
# shellcheck source=tests/fettle-contact/plate.bash
. "$HERE/../fettle-contact/plate.bash"
plate > plate.pcd
awk 'BEGIN {
    n = 21 * 21
    printf "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z qw qx qy qz pass\nSIZE 4 4 4 4 4 4 4 4\nTYPE F F F F F F F F\nCOUNT 1 1 1 1 1 1 1 1\n"
    printf "WIDTH %d\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS %d\nDATA ascii\n", n, n
    for (j = 0; j < 21; ++j) for (i = 0; i < 21; ++i) printf "%g %g 5.25 1 0 0 0 %d\n", 2 * i - 20, 2 * j - 20, j }' > rows.pcd
constant() { # FACTOR WHEEL OPTION…
    fettle-feed rows.pcd --on plate.pcd --wheel "$2" --cells 16 --rounds 1 --min 0.01 --max 10000 --feed 5 --report feed.json "${@:3}" > feed.pcd
    jq -c --argjson by "$1" '{constant: (.constant / $by)}' feed.json
}
wheel=$SAMPLES/wheels/crowned_preston.json
jq '.belt_speed *= 2' "$wheel" > fast.json
constant 1 "$wheel" --force 5 > once.json
constant 2 "$wheel" --force 10 | fettle-diff - once.json --rel 0.03
constant 2 fast.json --force 5 | fettle-diff - once.json --rel 1e-3
constant 2 "$wheel" --force 5 --wanted 0.125 | fettle-diff - once.json --rel 0.03
