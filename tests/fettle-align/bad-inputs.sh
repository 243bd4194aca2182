# Everything refused: exit 2, one line that names the file or option and the value, nothing on stdout.
refuses() { "$HERE/../refuses" "$@" </dev/null; }
awk 'BEGIN { for (i = 0; i < 300; i++) print i % 20, int(i / 20), (i % 7) * (i % 3) }' >good.xyz
: >empty.xyz
printf '1 2 3\n' >one.xyz
for i in 1 2 3 4 5 6 7 8; do echo 5 5 5; done >equal.xyz
for i in 1 2 3 4 5 6 7 8; do echo nan nan nan; done >nan.xyz
printf '1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n' >identity.txt
refuses empty.xyz fettle-align empty.xyz --to good.xyz
refuses empty.xyz fettle-align good.xyz --to empty.xyz
refuses 'one.xyz: needs at least 6 points, got 1' fettle-align one.xyz --to good.xyz
refuses 'one.xyz: needs at least 3 points, got 1' fettle-align good.xyz --to one.xyz
refuses 'equal.xyz: all points coincide' fettle-align equal.xyz --to good.xyz
refuses 'nan.xyz: needs at least 6 points, got 0' fettle-align nan.xyz --to good.xyz
refuses 'nan.xyz: needs at least 3 points, got 0' fettle-align good.xyz --to nan.xyz
printf 'solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 0 0 0\nvertex 1 0 0\nendloop\nendfacet\nendsolid a\n' >flat.stl
refuses 'flat.stl: all triangles have zero area' fettle-align good.xyz --to flat.stl
refuses missing.pcd fettle-align good.xyz --to missing.pcd
refuses -- fettle-align good.xyz
# transforms
transform() { # MESSAGE TEXT
    printf -- "$2" >T.txt
    refuses "T.txt: $1" fettle-align good.xyz --to good.xyz --transform-in T.txt
}
transform 'empty, expected a transform' ''
transform 'line 2: expected 4 numbers, got 3' '1 0 0 0\n0 1 0\n'
transform "line 1: expected a number, got '1,5'" '1 0 0 1,5\n'
transform "line 1: expected a number, got 'nan'" '1 0 0 nan\n'
transform 'line 5: a transform has only 4 lines' '1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n0 0 0 1\n'
transform 'the last line must be 0 0 0 1' '1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 1 1\n'
transform 'is not a rotation' '2 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n'
transform 'is a reflection' '-1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n'
# options
refuses "--hold: expected some of x,y,z,rx,ry,rz with commas between, got 'x,w'" fettle-align good.xyz --to good.xyz --hold x,w
refuses '--overlap' fettle-align good.xyz --to good.xyz --overlap 0
refuses '--overlap' fettle-align good.xyz --to good.xyz --overlap 0.5 --max-distance 1
refuses '--max-distance' fettle-align good.xyz --to good.xyz --max-distance -1
refuses '--iterations' fettle-align good.xyz --to good.xyz --iterations -1
refuses '--file-units' fettle-align good.xyz --to good.xyz --file-units ft
refuses '--transform-in' fettle-align good.xyz --to good.xyz --transform-in identity.txt --transform-in identity.txt
# a transform with CRLF and a mark at its beginning is read; nothing overlaps: exit 1
printf '\357\273\2771 0 0 0\r\n0 1 0 0\r\n0 0 1 0\r\n0 0 0 1\r\n' >crlf.txt
fettle-align good.xyz --to good.xyz --transform-in crlf.txt -o /dev/null -q
awk '{ print $1 + 1000, $2, $3 }' good.xyz >far.xyz
status=0
fettle-align far.xyz --to good.xyz --near --max-distance 1 -o /dev/null -q --report r.json || status=$?
test $status -eq 1
jq -e '.overlap == 0 and .median == null and (.converged | not)' r.json >/dev/null
# begun 500 m away: told after one step
awk '{ print $1 + 500000, $2, $3 }' good.xyz >away.xyz
status=0
fettle-align away.xyz --to good.xyz --near -o /dev/null 2>said || status=$?
test $status -eq 1
grep -q 'fettle-align: warning: away.xyz: begins .* mm from the reference' said
