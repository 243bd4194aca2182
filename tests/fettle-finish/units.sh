# One design in mm, inches and metres gives the same path, in mm; taken for the wrong unit it is warned of. Reference: each other.
printf 'OFF\n4 2 0\n0 0 5\n40 0 8\n40 30 5\n0 30 4\n3 0 1 2\n3 0 2 3\n' > mm.off
for unit in mm in m; do
    case $unit in mm) mm=1 ;; in) mm=25.4 ;; m) mm=1000 ;; esac
    awk -v mm=$mm 'NR > 2 && NF == 3 { printf "%.17g %.17g %.17g\n", $1 / mm, $2 / mm, $3 / mm; next } { print }' mm.off > $unit-file.off
    fettle-finish $unit-file.off --file-units $unit --cutter ball:6 --scallop 0.1 --pcd --ascii --report $unit.json 2> message > $unit.pcd
    [ ! -s message ]
    sed '1,/^DATA/d' $unit.pcd > $unit.points
done
grep -q '^FIELDS x y z feed$' mm.pcd
for unit in in m; do
    "$HERE/../scales" $unit 0 mm.json $unit.json
    paste -d ' ' mm.points $unit.points | awk '{ for (k = 1; k <= 4; k++) { d = $k - $(4 + k); if (d > 1e-4 || d < -1e-4) { print; exit 1 } } }'
done
fettle-finish m-file.off --cutter ball:6 --step-over 0.01 2> message > small.nc
grep -qF 'warning: m-file.off: the design, 0.04 x 0.03 x 0.004 mm, is less than 0.2 times as long as the cutter' message
fettle-finish mm.off --file-units m --cutter ball:6 --step-over 1000 2> message > large.nc
grep -qF 'warning: mm.off: the design, 40000 x 30000 x 4000 mm, is over 1000 times as long as the cutter' message
