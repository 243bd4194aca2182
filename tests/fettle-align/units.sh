# A part in inches against a reference in metres: lengths and the transform in the scan's unit, and fields and viewpoint go with it.
fettle-part "$SAMPLES/parts/hammer.json" >part.stl
fettle-align part.stl --to part.stl --near --iterations 0 --ascii | awk '
    $1 == "FIELDS" { print $0, "tag", "normal_x", "normal_y", "normal_z"; next } $1 == "SIZE" { print $0, "4 4 4 4"; next }
    $1 == "TYPE" { print $0, "I F F F"; next } $1 == "COUNT" { print $0, "1 1 1 1"; next } $1 == "VIEWPOINT" { print "VIEWPOINT 1 0 0 1 0 0 0"; next }
    /^# units/ { print "# units in"; next } data { print $1 / 25.4, $2 / 25.4, $3 / 25.4, n++, 1, 0, 0; next } { print } $1 == "DATA" { data = 1 }' >inch.pcd
fettle-align part.stl --to part.stl --near --iterations 0 --ascii | awk 'data { print $1 / 1000, $2 / 1000, $3 / 1000 } $1 == "DATA" { data = 1 }' >metres.xyz
cat >turn.txt <<'T'
0 -1 0 2
1 0 0 0
0 0 1 0
0 0 0 1
T
fettle-align inch.pcd --to metres.xyz --to-units m --transform-in turn.txt --iterations 0 -o moved.pcd
fettle-align moved.pcd --to metres.xyz --to-units m --max-distance 0.02 --transform-out T.txt --report r.json --ascii -o back.pcd
jq -e '.units.length == "in" and .median < 1e-4 and .max_distance == 0.02 and .dropped == 0' r.json >/dev/null
fettle-diff --tol 1e-4 inch.pcd back.pcd
grep -q '^VIEWPOINT' back.pcd
awk '$1 == "VIEWPOINT" { exit !(($2 - 1)^2 + $3^2 + $4^2 < 1e-6) }' back.pcd
fettle-align inch.pcd --to metres.xyz --to-units m --transform-in turn.txt --iterations 0 --ascii | awk '
    $1 == "VIEWPOINT" { if ($2 != 2 || $3 != 1 || ($8 - sqrt(0.5))^2 > 1e-12) exit 1 }
    data && !($5 == 0 && $6 == 1 && $7 == 0) { exit 1 } $1 == "DATA" { data = 1 }'
