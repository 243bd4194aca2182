# One pair of surfaces in mm, inches and metres: all numbers and fields of what comes out are the same, in mm. Reference: each other.
# shellcheck source=tests/fettle-verify/offset.bash
. "$HERE/offset.bash"
ramp 0.5 0 -2 12 7 | awk 'NF == 3 && NR > 2 { $3 += 0.002 * $1 * $1 * $2 } { print }' > design.off
ramp 0.5 0.1 0 10 10 | awk 'NF == 3 && NR > 2 { $3 += 0.02 * sin($1 * $2) } { print }' > part.off
printf 'G0 X0 Y0 Z20\nG1 X10 Y4 Z6 F600\nG1 X2 Y9\n' > path.nc
for unit in mm in m; do
    case $unit in mm) mm=1 ;; in) mm=25.4 ;; m) mm=1000 ;; esac
    for mesh in design part; do
        awk -v mm=$mm 'NR > 2 && NF == 3 { printf "%.17g %.17g %.17g\n", $1 / mm, $2 / mm, $3 / mm; next } { print }' $mesh.off > $mesh-$unit.off
    done
    fettle-verify part-$unit.off --file-units $unit --design design-$unit.off --design-units $unit --method closest --csv $unit.csv --z-errors z.pcd \
        --correct path.nc --corrected $unit.nc --cutter ball:3 --ascii -q --report $unit.json > $unit.pcd || [ $? = 1 ]
    grep -h '^FIELDS' $unit.pcd z.pcd >> fields
    sed '1,/^DATA/d' $unit.pcd | cut -d ' ' -f 1-10 > $unit.points
    sed '1,/^DATA/d' z.pcd | cut -d ' ' -f 1-4 >> $unit.points
    cut -d, -f 1-7 $unit.csv | sed 1d | tr ',' ' ' >> $unit.points
done
for unit in in m; do
    "$HERE/../scales" $unit 0 mm.json $unit.json
    paste -d ' ' mm.points $unit.points | awk '{ n = NF / 2; for (k = 1; k <= n; k++) { d = $k - $(n + k); if (d > 1e-4 || d < -1e-4) { print; exit 1 } } }'
    diff mm.nc $unit.nc || paste mm.nc $unit.nc | tr -d 'A-Z' | awk '{ n = NF / 2; for (k = 1; k <= n; k++) { d = $k - $(n + k); if (d > 1e-4 || d < -1e-4) exit 1 } }'
done
[ "$(sort -u fields)" = 'FIELDS x y z error
FIELDS x y z error closest d class normal_x normal_y normal_z rgb' ]
