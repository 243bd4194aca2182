# A path that says too little, too much or nonsense ends with status 2 and one line that names it.
# shellcheck source=tests/fettle-contact/plate.bash
. "$HERE/../fettle-contact/plate.bash"
plate > plate.pcd
wheel 10 0.45 > wheel.json
path() { # POSE...: one a point
    printf '# .PCD v0.7\nVERSION 0.7\nFIELDS x y z qw qx qy qz\nSIZE 4 4 4 4 4 4 4\nTYPE F F F F F F F\nCOUNT 1 1 1 1 1 1 1\n'
    printf 'WIDTH %d\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS %d\nDATA ascii\n' $# $#
    printf '%s\n' "$@"
}
path '0 0 5 1 0 0 0' '1 0 5 1 0 0 0' > path.pcd
path '0 0 5 1 0 0 0' '900 0 5 1 0 0 0' > away.pcd
path '0 0 5 0 0 0 0' > turned.pcd
refused() { "$HERE/../refuses" "$@"; }
refused 'path.pcd: no field force or depth' fettle-belt plate.pcd --wheel wheel.json --path path.pcd
refused 'one of them' fettle-belt plate.pcd --wheel wheel.json --path path.pcd --force 1 --depth 1
refused 'away.pcd: point 1: there is nothing under the wheel' fettle-belt plate.pcd --wheel wheel.json --path away.pcd --force 1
refused 'away.pcd: point 1: there is nothing under the wheel' fettle-belt plate.pcd --wheel wheel.json --path away.pcd --force 1 --learn new.json
refused 'turned.pcd: point 0' fettle-belt plate.pcd --wheel wheel.json --path turned.pcd --force 1
refused '--feed' fettle-belt plate.pcd --wheel wheel.json --path path.pcd --force 1 --feed 0
refused '--model' fettle-belt plate.pcd --wheel wheel.json --path path.pcd --force 1 --model none
refused '--path' fettle-belt plate.pcd --wheel wheel.json --force 1
refused 'missing/trace.pcd' fettle-belt plate.pcd --wheel wheel.json --path path.pcd --force 1 --trace /missing/trace.pcd
sed 's/"preston"/"power"/' wheel.json > power.json
refused 'power.json: law.pressure_exponent' fettle-belt plate.pcd --wheel power.json --path path.pcd --force 1
# Laws of a belt that were written before the release hold forces, not pressures.
echo '{"kind": "law", "learnt": {"record": {"pass_work": 1e6, "passes": [[20, 0, 10, 0, 0, 1]]}}}' > old.json
refused 'old.json: a pass has a pressure of 20 MPa, more than the modulus' fettle-belt plate.pcd --wheel wheel.json --path path.pcd --force 1 --learn old.json
refused '--ascii: goes with PCD, not with csv' fettle-belt plate.pcd --wheel wheel.json --path path.pcd --force 1 --cells 16 --ascii --format csv
