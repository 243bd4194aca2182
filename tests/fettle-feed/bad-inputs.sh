# What cannot be planned ends with status 2 and one line.
# shellcheck source=tests/fettle-contact/plate.bash
. "$HERE/../fettle-contact/plate.bash"
plate > plate.pcd
wheel 10 0.45 > wheel.json
printf '# .PCD v0.7\nVERSION 0.7\nFIELDS x y z qw qx qy qz\nSIZE 4 4 4 4 4 4 4\nTYPE F F F F F F F\nCOUNT 1 1 1 1 1 1 1\nWIDTH 2\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 2\nDATA ascii\n0 0 5 1 0 0 0\n1 0 5 1 0 0 0\n' > path.pcd
sed 's/^[01] 0 5/nan nan nan/' path.pcd > off.pcd
sed 's/^[01] 0 5/900 0 5/' path.pcd > away.pcd
sed '/^DATA/q' path.pcd | sed 's/^WIDTH 2/WIDTH 0/; s/^POINTS 2/POINTS 0/' > empty.pcd
refused() { "$HERE/../refuses" "$@"; }
refused 'path.pcd: no field force or depth' fettle-feed path.pcd --on plate.pcd --wheel wheel.json
refused 'one of them' fettle-feed path.pcd --on plate.pcd --wheel wheel.json --force 1 --depth 1
refused 'path.pcd: point 0: is pressed to a depth' fettle-feed path.pcd --on plate.pcd --wheel wheel.json --depth 0.2 --vary force
refused 'is above --max' fettle-feed path.pcd --on plate.pcd --wheel wheel.json --force 1 --min 5 --max 4
refused '--lower and --upper go together' fettle-feed path.pcd --on plate.pcd --wheel wheel.json --force 1 --lower 0
refused 'is not below --upper' fettle-feed path.pcd --on plate.pcd --wheel wheel.json --force 1 --lower 0.1 --upper 0.1
refused '--min' fettle-feed path.pcd --on plate.pcd --wheel wheel.json --force 1 --min 0
refused 'off.pcd: no point is on the part' fettle-feed off.pcd --on plate.pcd --wheel wheel.json --force 1
refused 'empty.pcd: no point is on the part' fettle-feed empty.pcd --on plate.pcd --wheel wheel.json --force 1
refused 'away.pcd: point 0: there is nothing under the wheel' fettle-feed away.pcd --on plate.pcd --wheel wheel.json --force 1
sed 's/{"type": "preston", "coefficient": 1e-8}/{"type": "power", "coefficient": 1e-8, "pressure_exponent": 1, "speed_exponent": 1, "threshold": 1000}/' wheel.json > blunt.json
refused 'path.pcd: the belt removes nothing along the path' fettle-feed path.pcd --on plate.pcd --wheel blunt.json --force 1
refused '--on' fettle-feed path.pcd --wheel wheel.json --force 1
refused 'missing.json' fettle-feed path.pcd --on plate.pcd --wheel missing.json --force 1
