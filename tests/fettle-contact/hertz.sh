# A ball-like wheel of 60 mm on a plate, its rubber 55 mm thick: Hertz (a = ∛(3 F R / 4 E*), p0 = 3 F / 2π a²) within what
# the hub holds back at h/a = 15, by force and to the depth that this took; and the pressure sums up to the force. The same
# in inches, from surfels in inches. The same bytes with one thread and two.
# Reference: Johnson 1985, 4.2.
# shellcheck source=tests/fettle-contact/plate.bash
. "$HERE/plate.bash"
plate > plate.pcd
wheel 55 0.3 > wheel.json
press() { fettle-contact "$1" --wheel wheel.json --at "$2" "${@:3}"; }
press plate.pcd 0,0,5.25,1,0,0,0 --force 5 --report force.json --ascii --threads 1 > force.pcd
press plate.pcd 0,0,5.25,1,0,0,0 --force 5 --ascii --threads 2 | cmp - force.pcd
jq -e '(5 / (1 - 0.09)) as $E | (3 * 5 * 60 / (4 * $E) | cbrt) as $a | .force - 5 < 1e-9 and
       (.peak_pressure / (3 * 5 / (2 * 3.14159265 * $a * $a)) - 1 | fabs) < 0.03 and
       (.area / (3.14159265 * $a * $a) - 1 | fabs) < 0.03 and .near_edge' force.json > ok
jq -n '(5 / (1 - 0.09)) as $E | (3 * 5 * 60 / (4 * $E) | cbrt) as $a | {peak_pressure: (3 * 5 / (2 * 3.14159265 * $a * $a)), area: (3.14159265 * $a * $a)}' > hertz.json
jq '{peak_pressure, area}' force.json | fettle-diff - hertz.json --rel 0.03
jq -r .indentation force.json > depth
press plate.pcd 0,0,5.25,1,0,0,0 --depth "$(cat depth)" --report depth.json > depth.pcd
jq -e '(.force / 5 - 1 | fabs) < 1e-4' depth.json > ok
sed '1,/^DATA/d' force.pcd | awk -v cell="$(jq '.cell[0] * .cell[1]' force.json)" '{ f += $4 * cell } END { exit !(f > 4.9999 && f < 5.0001) }'
awk '/^POINTS|^#/ || NF != 7 || /^[A-Z]/ { print; next } { printf "%.9g %.9g %.9g %s %s %s %.9g\n", $1 / 25.4, $2 / 25.4, $3 / 25.4, $4, $5, $6, $7 / 25.4 }' plate.pcd > inch.pcd
press inch.pcd 0,0,0.20669291,1,0,0,0 --force 5 --file-units in --report inch.json > inch.out
jq -e --slurpfile mm force.json '(.indentation * 25.4 / $mm[0].indentation - 1 | fabs) < 1e-3 and
       (.area * 645.16 / $mm[0].area - 1 | fabs) < 1e-2' inch.json > ok
