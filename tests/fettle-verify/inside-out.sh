# A closed design that is inside out is turned over, and that is said; an open one that faces down is refused. What is left out
# of a mesh is said, and a size that can hardly be meant. Reference: the right design.
# shellcheck source=tests/fettle-verify/offset.bash
. "$HERE/offset.bash"
block() { # "a, b, c": how its facets are wound
    printf 'OFF\n8 12 0\n-5 -5 0\n5 -5 0\n-5 5 0\n5 5 0\n-5 -5 5\n5 -5 5\n-5 5 5\n5 5 5\n'
    printf '%d %d %d\n' 0 2 1 1 2 3 4 5 6 5 7 6 0 1 4 1 5 4 2 6 3 3 6 7 0 4 2 2 4 6 1 3 5 3 7 5 | awk "{ print 3, $1 }"
}
block '$1, $2, $3' > right.off
block '$2, $1, $3' > wrong.off
ramp 0 5.02 -4 4 8 > part.off
fettle-verify part.off --design right.off --method closest --report right.json > right.pcd 2> message
[ ! -s message ]
fettle-verify part.off --design wrong.off --method closest --report wrong.json 2> message | cmp - right.pcd
[ "$(cat message)" = 'fettle-verify: warning: wrong.off: 12 facets that were wound inwards are turned over' ]
cmp wrong.json right.json
ramp 0.5 0 -5 5 4 > up.off
awk 'NF == 4 { print $1, $3, $2, $4; next } { print }' up.off > down.off
"$HERE/../refuses" 'down.off: no facet of the design faces up' fettle-verify part.off --design down.off
# Most of it turned over, by pieces that do not touch.
printf 'OFF\n9 3 0\n0 0 0\n1 0 0\n0 1 0\n2 0 0\n2 1 0\n3 0 0\n4 0 0\n4 1 0\n5 0 0\n3 0 1 2\n3 3 4 5\n3 6 7 8\n' > mixed.off
"$HERE/../refuses" 'mixed.off: more of the open design faces down than up: is it inside out?' fettle-verify part.off --design mixed.off
awk 'NR == 2 { $1 += 1; $2 += 1 } { print } NR == 83 { print "1 nan 3" } END { print 3, 0, 1, 81 }' part.off > gap.off
fettle-verify gap.off --design right.off --method closest 2> message > gap.pcd
cmp gap.pcd right.pcd
grep -qF 'warning: gap.off: 1 facet with NaN or infinite corners left out' message
fettle-verify part.off --file-units m --design right.off -q > far.pcd || [ $? = 1 ]
fettle-verify part.off --file-units m --design right.off 2> message > far.pcd || [ $? = 1 ]
grep -qF 'part.off: the machined surface, 8000 x 8000 x 0 mm, is over 100 times as long as the design: is its unit right?' message
