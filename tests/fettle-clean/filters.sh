# Each filter takes away what it says, counts it, and leaves the rest with its fields in its order. Reference: points laid by hand.
cat > points.xyz <<'XYZ'
x y z shade
0 0 0 1
1 0 0 2
nan 0 0 3
2 0 0 4
0 0 0 5
2 0 0 6
3 0 5 7
3 4 0 8
9 9 9 9
XYZ
left() { # OPTION…: the shades of what is left
    fettle-clean points.xyz "$@" --ascii --report report.json | sed '1,/^DATA/d' | cut -d ' ' -f 4 | tr -d '\n'
}
[ "$(left)" = 24789 ]
jq -e '.points == 9 and .invalid == 1 and .at_origin == 2 and .duplicates == 1 and .points_left == 5' report.json > ok
[ "$(left --crop box:0,0,0,3,9,4)" = 248 ]
jq -e '.cropped == 2' report.json > ok
[ "$(left --crop sphere:0,0,0,5)" = 248 ]
[ "$(left --crop polygon:0,4.9,0.5,-1,4,-1,4,5,0.5,5)" = 248 ]
[ "$(left --crop polygon:0,5,0.5,-1,4,-1,4,5,0.5,5)" = 2478 ]
echo '{ "kind": "job", "units": {"length": "mm"}, "surface": {"type": "freeform"}, "anomaly": [[1, -1], [2, -1], [2, 1], [1, 1]],
    "sampling": [[0.5, -2], [4, -2], [4, 1], [0.5, 1]] }' > job.json
[ "$(left --crop job.json)" = 247 ]
jq '.units.length = "in" | (.anomaly, .sampling) |= map(map(. / 25.4))' job.json > inch.json
[ "$(left --crop inch.json --file-units mm)" = 247 ]
# One (0, 0, 0) may be a corner of the part.
printf '0 0 0\n1 0 0\n' | fettle-clean --report report.json > two.pcd
jq -e '.at_origin == 0 and .points_left == 2' report.json > ok

# Both filters find the one outlier, far off a grid with 1 mm between its points.
awk 'BEGIN { for (x = 0; x < 10; ++x) for (y = 0; y < 10; ++y) print x, y, 0; print 5, 5, 40 }' > grid.xyz
for filter in statistical:4,3 radius:1.1,2; do
    fettle-clean grid.xyz --outliers $filter --ascii --report report.json | sed '1,/^DATA/d' > left
    jq -e '.outliers == 1' report.json > ok
    [ "$(wc -l < left)" = 100 ]
    if grep -q 40 left; then exit 1; fi
done
# Cubes of 2 mm hold four points at the same distance from their mean: the first stays. Points of a grid that are 2 mm apart stay by spacing.
fettle-clean grid.xyz --crop box:0,0,0,9,9,1 --thin 2 --ascii | sed '1,/^DATA/d' > left
[ "$(wc -l < left)" = 25 ]
[ "$(head -n 2 left | tr '\n' ' ')" = '0 0 0 0 2 0 ' ]
fettle-clean grid.xyz --crop box:0,0,0,9,9,1 --thin spacing:2 --ascii | sed '1,/^DATA/d' > spaced
cmp left spaced

# What faces up: of a cloud by its normals.
cat > sides.xyz <<'XYZ'
x y z normal_x normal_y normal_z
0 0 1 0 0 1
0 0 -1 0 0 -1
1 0 0 1 0 0
0 1 0.7 0 0.6 0.8
XYZ
fettle-clean sides.xyz --facing 0,0,3 --ascii --report report.json | sed '1,/^DATA/d' > left
jq -e '.facing_away == 2 and .points_left == 2' report.json > ok
