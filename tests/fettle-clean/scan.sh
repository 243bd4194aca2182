# A panel's scan with stray points, doubled points and lost echoes comes out as it was, in every unit, for any number of threads. Reference:
# the panel's own points.
fettle-clean "$SAMPLES/scans/panel.pcd" --ascii | sed '1,/^DATA/d' | awk '{ printf "%.9g %.9g %.9g\n", 1000 * $1, 1000 * $2, 1000 * $3 }' > points.xyz
fettle-clean points.xyz --ascii > clean.pcd
n=$(wc -l < points.xyz)
awk '{ print $0 } NR % 50 == 0 { print $0 } NR % 97 == 0 { print 0, 0, 0 } NR % 200 == 0 { print $1, $2, $3 + 60 + NR % 7000 / 100 }' points.xyz > dirty.xyz
fettle-clean dirty.xyz --outliers statistical:8,6 --ascii --report report.json > left.pcd
jq -e --argjson n "$n" '.points_left == $n and .duplicates == ($n / 50 | floor) and .at_origin == ($n / 97 | floor) and .outliers == ($n / 200 | floor)' report.json > ok
cmp clean.pcd left.pcd
for threads in 1 2 7; do fettle-clean dirty.xyz --outliers radius:5,3 --thin 4 --threads $threads --report $threads.json -o $threads.pcd; done
cmp 1.pcd 2.pcd
cmp 1.pcd 7.pcd
jq -e '.points_left > 4000 and .points_left < 8000' 1.json > ok # 320 x 260 mm in squares of 4 mm: 5,200, and what stands
# In metres: the same points. Lengths of the options are in the file's unit.
awk '{ printf "%.9g %.9g %.9g\n", $1 / 1000, $2 / 1000, $3 / 1000 }' dirty.xyz > metres.xyz
fettle-clean metres.xyz --file-units m --outliers radius:0.005,3 --thin 0.004 --report metres.json > metres.pcd
jq -e --slurpfile mm 1.json '(.points_left - $mm[0].points_left | fabs) <= 5' metres.json > ok # rounding at the cubes' faces
grep -a -q '^# units m' metres.pcd
