# What is no wheel, no pose, no surfel, or no contact ends with status 2 and one line that names it.
# shellcheck source=tests/fettle-contact/plate.bash
. "$HERE/plate.bash"
plate > plate.pcd
wheel 10 0.45 > wheel.json
refused() { "$HERE/../refuses" "$@"; }
at=0,0,5,1,0,0,0
refused 'either --force or --depth' fettle-contact plate.pcd --wheel wheel.json --at $at
refused 'either --force or --depth' fettle-contact plate.pcd --wheel wheel.json --at $at --force 1 --depth 1
refused '--force' fettle-contact plate.pcd --wheel wheel.json --at $at --force 0
refused 'expected a number for z and a comma' fettle-contact plate.pcd --wheel wheel.json --at 1,2,3 --force 1
refused 'quaternion' fettle-contact plate.pcd --wheel wheel.json --at 0,0,5,0,0,0,0 --force 1
refused 'nothing under the wheel' fettle-contact plate.pcd --wheel wheel.json --at 900,0,5,1,0,0,0 --force 1
refused 'nothing under the wheel' fettle-contact plate.pcd --wheel wheel.json --at 0,0,5,0,1,0,0 --force 1
grep -v '^#' plate.pcd | sed 's/normal_/other_/g' > bare.pcd
refused 'bare.pcd: no fields normal_x' fettle-contact bare.pcd --wheel wheel.json --at $at --force 1
wheel 10 0.6 > stiff.json
refused 'stiff.json: layer.poisson' fettle-contact plate.pcd --wheel stiff.json --at $at --force 1
wheel 61 0.4 > solid.json
refused 'solid.json: layer.thickness: is not less than the radius' fettle-contact plate.pcd --wheel solid.json --at $at --force 1
sed 's/"young": 5/"young": 5, "shore_a": 60/' wheel.json > both.json
refused 'both.json: layer.young' fettle-contact plate.pcd --wheel both.json --at $at --force 1
refused 'plate.pcd' fettle-contact plate.pcd --wheel plate.pcd --at $at --force 1
# A wheel as large as a planet, and rubber as thin as a film beside its radius: one took minutes, the other all memory.
sed 's/"radius": 60/"radius": 1e15/' wheel.json > planet.json
refused 'planet.json: radius: must be' fettle-contact plate.pcd --wheel planet.json --at $at --force 1
wheel 1e-5 0.45 > film.json
refused 'film.json: layer.thickness: is less than 0.0001 of the radius or the width, got 1e-05' fettle-contact plate.pcd --wheel film.json --at $at --force 1
