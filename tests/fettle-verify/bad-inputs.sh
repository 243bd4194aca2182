# What is no mesh and no tolerance ends with status 2, one line that names it, and nothing on stdout.
# shellcheck source=tests/fettle-verify/offset.bash
. "$HERE/offset.bash"
ramp 0 0 0 1 1 > ok.off
: > empty.stl
printf '1 2 3\n4 5 6\n' > points.xyz
refused() { "$HERE/../refuses" "$@"; }
refused 'empty.stl: empty' fettle-verify empty.stl --design ok.off
refused 'empty.stl: empty' fettle-verify ok.off --design empty.stl
refused 'points.xyz: points, expected a mesh' fettle-verify points.xyz --design ok.off
refused 'missing.stl' fettle-verify ok.off --design missing.stl
refused '--design' fettle-verify ok.off
refused '--tolerance' fettle-verify ok.off --design ok.off --tolerance 0
refused '--inner-tolerance' fettle-verify ok.off --design ok.off --inner-tolerance -1
refused '--neutral' fettle-verify ok.off --design ok.off --neutral 2
refused '--method' fettle-verify ok.off --design ok.off --method nearest
refused '--step: a cell of' fettle-verify ok.off --design ok.off --step 1e-9
refused '/missing/sheet.csv' fettle-verify ok.off --design ok.off --csv /missing/sheet.csv
