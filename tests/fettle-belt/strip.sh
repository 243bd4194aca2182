# A run over a plate: the surfels lose the volume of Preston's law (C V_b F t), a second belt adds to removed, and
# the trace has each point. To half the spacing the same depth; the same bytes with one thread and two.
# Reference: the law; volume of a plate whose surfels are 0.5 mm apart.
# shellcheck source=tests/fettle-contact/plate.bash
. "$HERE/../fettle-contact/plate.bash"
plate > plate.pcd
wheel 10 0.45 > wheel.json
path() { # SPACING: 10 mm along x on the stock
    awk -v d="$1" 'BEGIN {
        n = 10 / d + 1
        printf "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z qw qx qy qz\nSIZE 4 4 4 4 4 4 4\nTYPE F F F F F F F\nCOUNT 1 1 1 1 1 1 1\n"
        printf "WIDTH %d\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS %d\nDATA ascii\n", n, n
        for (i = 0; i < n; ++i) printf "%g 0 5.25 1 0 0 0\n", i * d - 5 }'
}
path 1 > coarse.pcd
path 0.5 > fine.pcd
grind() { fettle-belt plate.pcd --wheel wheel.json --force 10 --feed 5 --ascii --path "$@"; }
grind fine.pcd --report fine.json --trace trace.pcd --threads 1 > fine.out
grind fine.pcd --threads 2 | cmp - fine.out
grind coarse.pcd > coarse.out
jq -e '(1e-8 * 15000 * 10 * 2) as $law | (.removed_volume / $law - 1 | fabs) < 1e-4 and (.time - 2 | fabs) < 1e-9 and .points == 21 and
       .surfels == 6561 and .touched < 2000 and (.max_force - 10 | fabs) < 1e-6' fine.json > ok
lost() { sed '1,/^DATA/d' "$1" | awk '{ v += $8; if ($7 + $8 != 0.25 && ($7 + $8 - 0.25) ^ 2 > 1e-12) exit 1 } END { print v / 4 }'; }
lost fine.out > fine.lost
lost coarse.out > coarse.lost
awk 'NR == 1 { a = $1 } NR == 2 { exit !(a / 0.003 > 0.999 && a / 0.003 < 1.001 && $1 / a > 0.995 && $1 / a < 1.005) }' fine.lost coarse.lost
fettle-belt fine.out --wheel wheel.json --force 10 --feed 5 --ascii --path fine.pcd > twice.out
lost twice.out > twice.lost
awk 'NR == 1 { a = $1 } NR == 2 { exit !($1 / a > 1.999 && $1 / a < 2.001) }' fine.lost twice.lost
sed '1,/^DATA/d' trace.pcd | awk 'NR == 1 || NR == 21 { if (($9 - 10) ^ 2 > 1e-9) exit 1 } END { exit !(NR == 21 && ($8 - 2) ^ 2 < 1e-18) }'
# Hammann's global model takes the same volume; the belt's work is force * V_b * time, and a belt worn by wear_work cuts 1/e of it.
grind fine.pcd --model global --report global.json > global.out
jq -e '(.removed_volume / 3e-3 - 1 | fabs) < 1e-4 and (.work / 300 - 1 | fabs) < 1e-6' global.json > ok
! cmp -s global.out fine.out || exit 1
sed 's/1e-8}/1e-8, "wear_work": 1e9}/' wheel.json > wearing.json
fettle-belt plate.pcd --wheel wearing.json --force 10 --feed 5 --path fine.pcd --worn 1e9 --report worn.json > worn.out
jq -e '.removed_volume / 3e-3 | . > 0.3678 and . < 0.3680' worn.json > ok
# Deeper by option, force and feed by fields.
fettle-belt plate.pcd --wheel wheel.json --depth 0.2 --feed 5 --path fine.pcd --report depth.json > depth.out
jq -e '.max_force > 0 and .removed_volume > 0' depth.json > ok
sed 's/^FIELDS.*/& force feed/; s/^SIZE.*/& 4 4/; s/^TYPE.*/& F F/; s/^COUNT.*/& 1 1/; /^-*[0-9].* 0 0 0$/s/$/ 10 5/' fine.pcd > fields.pcd
fettle-belt plate.pcd --wheel wheel.json --ascii --path fields.pcd | cmp - fine.out
# With both fields the depth holds where there is one.
sed 's/^FIELDS.*/& depth force feed/; s/^SIZE.*/& 4 4 4/; s/^TYPE.*/& F F F/; s/^COUNT.*/& 1 1 1/; /^-*[0-9].* 0 0 0$/s/$/ nan 10 5/' fine.pcd > both.pcd
fettle-belt plate.pcd --wheel wheel.json --ascii --path both.pcd | cmp - fine.out
sed '$s/nan 10/0.2 10/' both.pcd > last.pcd
fettle-belt plate.pcd --wheel wheel.json --path last.pcd --ascii --trace traced.pcd > last.out
sed '1,/^DATA/d' traced.pcd | awk 'NR < 21 && ($9 - 10) ^ 2 > 1e-9 || NR == 21 && ($12 - 0.2) ^ 2 > 1e-12 { exit 1 } END { exit NR != 21 }'
# A strip in inches gives the same.
awk '/^VERSION/ { print "# units in N" } /^-*[0-9]/ { $1 /= 25.4; $2 /= 25.4; $3 /= 25.4; $10 /= 25.4 }
    /^-*[0-9]/ && $8 != "nan" { $8 /= 25.4 } { print }' last.pcd > inches.pcd
fettle-belt plate.pcd --wheel wheel.json --path inches.pcd --ascii | fettle-diff - last.out --tol 1e-6
sed 's/nan 10/nan nan/' both.pcd > neither.pcd
"$HERE/../refuses" 'neither.pcd: point 0: neither force nor depth' fettle-belt plate.pcd --wheel wheel.json --path neither.pcd
