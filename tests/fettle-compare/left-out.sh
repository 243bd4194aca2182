# What reading a mesh leaves out is said in one line for each file and is no point of the comparison: facets with NaN
# corners, vertices of no facet, the second side of a mesh drawn from both. Reference: a plate, by hand.
plate='v 0 0 0\nv 30 0 0\nv 30 30 0\nv 0 30 0\n'
{ printf "$plate"; printf 'f 1 2 3 4\n'; } >plate.obj
{ printf "$plate"; printf 'v 9000 0 0\nv nan 0 0\nf 1 2 3 4\nf 1 2 6\n'; } >loose.obj
{ printf "$plate"; printf 'f 1 2 3\nf 1 3 4\nf 3 2 1\nf 4 3 1\n'; } >both.obj
printf '5 5 0.5\n20 5 -0.25\n' >test.xyz
fettle-compare loose.obj --to plate.obj --report r.json -o errors.pcd 2>err
[ "$(cat err)" = 'fettle-compare: warning: loose.obj: 1 facet with NaN or infinite corners and 1 vertex of no facet left out' ]
jq -e '.count == 4 and .undefined == 0 and .mean == 0' r.json >/dev/null
fettle-compare test.xyz --to loose.obj --report r.json -o errors.pcd 2>err
[ "$(cat err)" = 'fettle-compare: warning: loose.obj: 1 facet with NaN or infinite corners and 1 vertex of no facet left out' ]
jq -e '.min == -0.25 and .max == 0.5 and .reference.dropped_facets == 1 and .reference.unused_vertices == 1' r.json >/dev/null
fettle-compare test.xyz --to both.obj --report r.json -o errors.pcd 2>err
[ "$(cat err)" = 'fettle-compare: warning: both.obj: 2 facets repeat another wound the other way and are left out: the first defines the outer side' ]
jq -e '.min == -0.25 and .max == 0.5 and .reference.opposite_facets == 2' r.json >/dev/null
# Other tools say the same, and a comparison of files counts it.
for command in 'form flatness loose.obj -o out' 'render loose.obj -o out' 'align loose.obj --to both.obj --near --iterations 0 -o out'; do
    fettle-$command 2>err
    grep -q 'loose.obj: 1 facet with NaN or infinite corners and 1 vertex of no facet left out' err
done
status=0
fettle-diff plate.obj loose.obj >out || status=$?
[ $status -eq 1 ]
grep -q 'NaN or infinite' out
grep -q 'vertices of no triangle' out
