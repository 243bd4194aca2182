# Triangles that are malformed, and such that are only unusual, in every place where a tool reads a mesh: the first are refused, the
# others read, or refused in one line; within the bounds of probe.bash.
# shellcheck source=tests/bad-inputs/probe.bash
. "$HERE/probe.bash"
good
meshes G plate.stl
head80() { printf '%-80s' "$1"; }
flat='0 0 5 40 0 5 40 40 5' other='0 0 5 40 40 5 0 40 5'
tri() { # COORDINATE…: 9, little-endian, with a normal and an attribute
    binary 'f<12v' 0 0 1 "$@" "${attribute:-0}"
}
two() { tri $flat; tri $other; }
: >empty.stl
head80 short | head -c 60 >short.stl
{ head80 x; binary V 0; } >none.stl
{ head80 x; binary V 3; two; } >few.stl
{ head80 x; binary V 1; two; } >many.stl
{ head80 x; binary V 4294967295; two; } >most.stl
{ head80 x; binary N 2; perl -e 'for (1, 2) { print pack("f>12n", 0, 0, 1, 0, 0, 5, 40, 0, 5, 40, 40, 5, 0) }'; } >big-endian.stl
{ echo 'solid a'; facet $flat; binary 'f<24' $(seq 24); } >tail.stl
{ echo 'solid a'; facet $flat | sed '/endfacet/d'; facet $other; echo endsolid; } >no-endfacet.stl
{ echo 'solid a'; facet $flat | sed 's/^endloop/vertex 0 40 5\nendloop/'; echo endsolid; } >four.stl
{ echo 'solid a'; facet $flat | sed 's/40/4O/'; echo endsolid; } >letter.stl
{ echo 'solid a'; echo endsolid; } >no-facets.stl
for file in *.stl; do [ "$file" = plate.stl ] || meshes R "$file"; done
mkdir unusual
cd unusual
cp ../*.json ../good.pcd ../plate.stl ../path.nc .
{ head80 'solid as only text should be'; binary V 2; two; } >solid.stl
{ head80 x; binary V 3; two; tri nan 0 5 40 0 5 40 40 inf; } >nan.stl
{ head80 x; binary V 2; tri 0 0 5 0 0 5 0 0 5; tri 0 0 5 20 20 5 40 40 5; } >no-area.stl
{ head80 x; binary V 3; two; tri 0 0 5 40 0 5 40 1e-7 5; } >needle.stl
{ head80 x; binary V 2; tri 0 0 5 40 40 5 40 0 5; tri 0 0 5 0 40 5 40 40 5; } >inside-out.stl
{ head80 x; binary V 2; tri $flat; tri 0 0 5 0 40 5 40 40 5; } >mixed.stl
{ head80 x; binary V 4; two; two; } >duplicate.stl
{ head80 x; binary V 4; two; tri 0 0 5 40 40 5 20 20 9; tri 0 0 5 40 40 5 20 20 1; } >non-manifold.stl
{ head80 x; binary V 4; two; tri 0 0 9 40 0 9 40 40 9; tri 0 0 9 40 40 9 0 40 9; } >two-shells.stl
{ head80 x; binary V 2; attribute=31775 tri $flat; attribute=33791 tri $other; } >coloured.stl
{ head80 x; binary V 2; tri 0 0 .005 .04 0 .005 .04 .04 .005; tri 0 0 .005 .04 .04 .005 0 .04 .005; } >metres.stl
{ head80 x; binary V 2; tri 0 0 1e38 1e38 0 0 1e38 1e38 0; tri $other; } >huge.stl
{ echo 'solid a'; facet $flat | sed 's/0 0 1$/nan nan nan/'; facet $other; echo 'endsolid a'; } >nan-normal.stl
{ echo 'solid a'; facet $flat; echo 'endsolid a'; echo 'solid b'; facet $other; echo 'endsolid b'; } >two-solids.stl
tr '[:lower:]' '[:upper:]' <plate.stl >upper.stl
box() { # X0 Y0 Z0 X1 Y1 Z1 WAY: twelve facets, their outer side out (1) or in (-1)
    awk -v "box=$*" 'function facet(a, b, c) {
            printf "facet normal 0 0 0\nouter loop\nvertex %s\nvertex %s\nvertex %s\nendloop\nendfacet\n", at[a], at[b], at[c] }
        BEGIN { split(box, v, " "); way = v[7]
            for (i = 0; i < 8; i++) at[i] = v[i % 2 ? 4 : 1] " " v[int(i / 2) % 2 ? 5 : 2] " " v[i > 3 ? 6 : 3]
            n = split("0231 4576 0154 2673 0462 1375", face, " ") # q[1], q[3] is their diagonal
            for (k = 1; k <= n; k++) { split(face[k], q, ""); facet(q[1], q[3 - way], q[3]); facet(q[1], q[3], q[3 + way]) } }'
}
{ echo 'solid a'; box 0 0 -15 40 40 5 1; box 10 10 -10 30 30 -5 -1; echo 'endsolid a'; } >cavity.stl
for file in *.stl; do meshes S "$file"; done
# Over the part, in its roof, near the cavity, in it, beneath it: the distances from the planes.
printf '20 20 6\n20 20 1\n20 20 -3\n20 20 -7.5\n20 20 -11\n' >through.xyz
fettle-compare through.xyz --to cavity.stl --format csv -q | cut -d , -f 7 | diff - <(printf '%s\n' error 1 -4 -2 2.5 -1)
# What can be read is read, and what is dropped is counted.
fettle-compare good.pcd --to nan.stl --report r.json -q -o errors.pcd
jq -e '[.. | numbers] | length > 0' r.json >numbers
for file in solid coloured duplicate two-solids upper nan-normal; do fettle-compare good.pcd --to $file.stl -q -o $file.pcd; done
all_tried 400
