# Finite elements of the layer. Far from its edges they agree with the Fourier layer to 3 % at h/R = 0.1; at the depth that
# the force took the force comes back; the pressure sums up to it; pressure times gap is below the tolerance; the same bytes
# with one thread and two. A narrow wheel lies on the plate across its whole width: the layer agrees with the elements to 5 %, and of more cells than
# it sees the edges with it is too stiff, and says so.
# shellcheck source=tests/fettle-contact/plate.bash
. "$HERE/plate.bash"
plate > plate.pcd
wheel 6 0.5 > wheel.json
press() { fettle-contact plate.pcd --wheel wheel.json --at "$1" "${@:2}"; }
press 0,0,5.25,1,0,0,0 --force 20 --report layer.json > layer.pcd
press 0,0,5.25,1,0,0,0 --force 20 --solver fem --tolerance 1e-8 --report fem.json --ascii --threads 1 > fem.pcd
press 0,0,5.25,1,0,0,0 --force 20 --solver fem --tolerance 1e-8 --ascii --threads 2 | cmp - fem.pcd
jq -e --slurpfile layer layer.json '(.indentation / $layer[0].indentation - 1 | fabs) < 0.03 and
       (.peak_pressure / $layer[0].peak_pressure - 1 | fabs) < 0.03 and (.near_edge | not)' fem.json > ok
sed '1,/^DATA/d' fem.pcd | awk -v cell="$(jq '.cell[0] * .cell[1]' fem.json)" -v max_product="$(jq '1e-8 * .peak_pressure * .indentation' fem.json)" \
    '{ f += $4 * cell * (1 - $1 * $1 / 60 / 60 / 2) } $4 * $5 > max_product || $4 < 0 || $5 < 0 { bad = 1 } END { exit bad || f < 19.999 || f > 20.001 }'
press 0,0,5.25,1,0,0,0 --depth "$(jq .indentation fem.json)" --solver fem --report depth.json > depth.pcd
jq -e '(.force / 20 - 1 | fabs) < 1e-4' depth.json > ok
sed -i 's/"crown_radius": 60,//; s/"width": 50/"width": 20/' wheel.json
press 0,0,5.25,1,0,0,0 --force 20 --report layer.json 2> silent > layer.pcd
press 0,0,5.25,1,0,0,0 --force 20 --solver fem --report fem.json 2>> silent > fem.pcd
[ ! -s silent ]
jq -e --slurpfile layer layer.json '.near_edge and (.indentation / $layer[0].indentation - 1 | fabs) < 0.05 and
       (.peak_pressure / $layer[0].peak_pressure - 1 | fabs) < 0.05' fem.json > ok
press 0,0,5.25,1,0,0,0 --force 20 --cells 129 --report edgeless.json 2> warned > edgeless.pcd
grep -q 'softer than computed; --solver fem' warned
jq -e --slurpfile layer edgeless.json '.indentation > 1.05 * $layer[0].indentation' fem.json > ok
"$HERE/../refuses" '--cells: at most 256' fettle-contact plate.pcd --wheel wheel.json --at 0,0,5.25,1,0,0,0 --force 1 --solver fem --cells 257
