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
printf 'G0 X0 Y0 Z5\nG1 Z1 F10\n' > path.nc
refused '--correct, --corrected and --cutter belong together' fettle-verify ok.off --design ok.off --correct path.nc
refused '--correct, --corrected and --cutter belong together' fettle-verify ok.off --design ok.off --cutter ball:6
refused '--cutter: expected ball:D' fettle-verify ok.off --design ok.off --correct path.nc --corrected c.nc --cutter drill:6
refused 'path.nc: a program has no contact points' fettle-verify ok.off --design ok.off --correct path.nc --corrected c.nc --cutter ball:6 --points cc
refused 'ok.off' fettle-verify ok.off --design ok.off --correct ok.off --corrected c.nc --cutter ball:6
[ ! -e c.nc ]
for option in --tolerance --inner-tolerance --outer-tolerance --step; do
    refused "$option" fettle-verify ok.off --design ok.off $option 1e300
    refused "$option" fettle-verify ok.off --design ok.off $option 1e-300
done
