# Rows there and back over a cylinder, a blade and a hull, and the two halves of a keel: joined, approached and left without contact but the
# strokes' own; from stroke to stroke no body of the cell is nearer to the part than the clearance, at the poses and between them. Unjoined
# rows go through the part. Reference: the exact bodies, and the clearance asked for.
. "$HERE/parts.bash"
robot=$SAMPLES/robots/irb1400.json
check() { fettle-collide "$robot" "$1.pcd" --workpiece "$1.stl" --tolerance 0.2 --track 1000 --report "$1.json" -q -o "$1-checked.pcd"; }
fettle-part "$SAMPLES/parts/keel.json" >keel.stl
awk '/^(FIELDS|SIZE|TYPE|COUNT)/ { $0 = $0 ($1 == "FIELDS" ? " pass" : $1 == "SIZE" ? " 4" : $1 == "TYPE" ? " F" : " 1") } data { $0 = $0 " " (n++ >= 30) } { print } $1 == "DATA" { data = 1 }' \
    "$SAMPLES/paths/keel.pcd" | fettle-path --clearance 15 --spacing 5 --part keel.stl -o keel.pcd
for part in cylinder blade hull keel; do
    [ $part = keel ] || "make_$part"
    check $part
    jq -e '.collisions == 0 and .collisions_between == 0 and .jumps == [] and .stamped and .min_between_strokes >= 15' $part.json >ok ||
        { jq -c '[.collisions, .collisions_between, .min, .min_between, .jumps, .stamped, .min_between_strokes]' $part.json; exit 1; }
    head -c 2000 $part-checked.pcd | grep -aq '^# checked [0-9a-f]\{64\} clearance [-0-9.e]* between [-0-9.e]* strokes [0-9.]* part [0-9a-f]\{16\}$'
done
# there and back without a turn of the tool, and with one of 180 degrees at each end
fettle-path <(fettle-surfel cylinder-top.stl --stock cylinder-top.stl --spacing 2 -q) --step-over 6 --spacing 4 >unjoined.pcd
cp cylinder.stl unjoined.stl
status=0
check unjoined || status=$?
test $status = 1
jq -e '.collisions_between > 0 and .stamped != true' unjoined.json >ok
head -c 2000 unjoined-checked.pcd | grep -aq '^# checked' && exit 1
# without a workpiece, or with another one than all of its triangles, nothing is stamped; nor where straight moves leave the joints' motion
fettle-collide "$robot" cylinder.pcd --track 1000 --report none.json -q -o /dev/null
jq -e '.stamped == false' none.json >ok
awk 'data && n++ % 60 { next } /^(WIDTH|POINTS)/ { $2 = 2 } { print } $1 == "DATA" { data = 1 }' "$SAMPLES/paths/keel.pcd" >far.pcd
fettle-collide "$robot" far.pcd --report far.json -q -v -o /dev/null 2>said || true
