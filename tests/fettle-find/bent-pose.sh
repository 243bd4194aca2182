# A mould that is nearly the same after half a turn, bent by 1.5 mm, against its design: the pose is the right one, and its five anomalies are found. Reference:
# the case, whose pose is the design's own. With a field that hardly strains each pose was judged by the bend left in it, and the wrong one, on which the part lies flatter, was taken.
find-case "$SAMPLES/designs/mould.stl" --scale 1000 --up -z --cell 1.5 --sigma 0.08 --number 4 --anomalies 5 --edge --bend 1.5 --design design.stl -q -o bent.pcd
fettle-find bent.pcd --against design.stl --transform-out pose.txt --report found.json > found.pcd 2> warnings || [ $? = 1 ]
awk 'NR <= 3 && $NR < 0.999 { exit 1 }' pose.txt
jq -e '.anomalies | length == 5' found.json > ok
