# PLY and OBJ files that are malformed (bad/) or unusual (unusual/), for the cases that try them in every place where a tool reads a
# mesh or points: a case each, as each starts tools some hundred times.
# shellcheck shell=bash
# shellcheck source=tests/bad-inputs/probe.bash
. "$HERE/probe.bash"
good
corners='0 0 5
40 0 5
40 40 5
0 40 5'
ply() { # SCRIPT: of sed, on a good file
    { printf 'ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n'
      printf '%s\n4 0 1 2 3\n' "$corners"; } | sed "$1"
}
obj() { sed 's/^/v /' <<<"$corners"; printf '%s\n' "$@"; }
ply '' >good.ply
obj 'f 1 2 3 4' >good.obj
mkdir bad
: >bad/empty.ply
ply 's/vertex 4/vertex 99999999999/' >bad/many.ply
ply 's/vertex 4/vertex -4/' >bad/negative.ply
ply '/element vertex/d' >bad/no-vertex.ply
ply 's/^element face 1/element vertex 1/' >bad/two-vertex.ply
ply 's/^4 0 1 2 3/255 0 1 2 3/' >bad/list-255.ply
ply 's/^4 0 1 2 3/-1 0 1 2 3/' >bad/list-negative.ply
ply 's/^4 0 1 2 3/4 0 1 2 7/' >bad/index.ply
ply 's/^4 0 1 2 3/4 0 1 2 -1/' >bad/index-negative.ply
ply 's/float x/quad x/' >bad/type.ply
ply '/end_header/d' >bad/no-end.ply
ply 's/ascii 1.0/ascii 2.0/' >bad/version.ply
ply 's/property float z/property float z\nproperty float nx\nproperty float normal_x/; s/ 5$/ 5 0 0/' >bad/two-names.ply
ply 's/^40 0 5/40 0/' >bad/short-row.ply
ply 's/^40 0 5/4,0 0 5/' >bad/comma.ply
{ ply '/end_header/q' | sed 's/ascii/binary_little_endian/; s/vertex 4/vertex 4000000000/'; printf '0123456789'; } >bad/binary-lies.ply
obj 'f 0 1 2' >bad/zero.obj
obj 'f 1 2 9' >bad/index.obj
obj 'f -9 1 2' >bad/relative.obj
obj 'f 1// 2// 3//x' >bad/slashes.obj
obj 'f 1 2' >bad/two.obj
obj 'v 1 2' 'f 1 2 3' >bad/short.obj
obj 'v 1 2 nonsense' 'f 1 2 3' >bad/word.obj
mkdir unusual
ply 's/^4 0 1 2 3/0/' >unusual/list-0.ply
ply 's/^element face/element edge 1\nproperty int a\nelement face/; s/^4 0 1 2 3/7\n4 0 1 2 3/' >unusual/other-first.ply
ply 's/property float z/property float z\nproperty list uchar int extra/; s/ 5$/ 5 2 1 1/' >unusual/list-on-vertices.ply
ply 's/$/\r/' >unusual/crlf.ply
ply 's/^property list/property uchar red\nproperty list/; s/^4 0 1 2 3/9 4 0 1 2 3/' >unusual/faces-in-colour.ply
ply 's/^40 0 5/nan 0 5/' >unusual/nan.ply
ply 's/^40 0 5/1e400 0 5/' >unusual/beyond.ply
{ ply '/end_header/q' | sed 's/ascii/binary_big_endian/'; binary 'f>12CN4' 0 0 5 40 0 5 40 40 5 0 40 5 4 0 1 2 3; } >unusual/big-endian.ply
ply 's/^40 0 5/20 10 5/' >unusual/concave.ply
obj 'f 1/1 2/2 3/3' >unusual/texture.obj
obj 'f -4 -3 -2 -1' >unusual/relative.obj
obj 'vn nan nan nan' 'f 1//1 2//1 3//1' >unusual/nan-normal.obj
obj 'f 1 1 1' 'f 1 2 3' >unusual/no-area.obj
