# What is no job, no part, or no command line.
refuses=$HERE/../refuses
echo '{"kind": "job", "units": {"length": "mm"}, "surface": {"type": "freeform"}, "anomaly": [[10, 10], [20, 10],
  [20, 20], [10, 20]], "sampling": [[0, 0], [30, 0], [30, 30], [0, 30]]}' > job.json
facet() { printf 'solid f\nfacet normal 0 0 1\nouter loop\nvertex %s\nvertex %s\nvertex %s\nendloop\nendfacet\nendsolid f\n' "$@"; }
facet '-9 -9 0' '99 -9 0' '-9 99 0' > part.stl
: > empty
"$refuses" 'empty: empty, expected JSON' fettle-sample empty --on part.stl
"$refuses" 'part.stl: ' fettle-sample part.stl --on part.stl
"$refuses" 'empty' fettle-sample job.json --on empty
"$refuses" 'job.json' fettle-sample job.json --on job.json
"$refuses" 'nowhere.stl' fettle-sample job.json --on nowhere.stl
"$refuses" 'job.json: touch points without z: name the part' fettle-sample job.json
"$refuses" '--tolerance' fettle-sample job.json --on part.stl --tolerance 1
"$refuses" '--on-units' fettle-sample job.json --on part.stl --on-units cm
"$refuses" '--seed' fettle-sample job.json --on part.stl --seed x
# the part lies elsewhere, is too small, or in another unit: every touch misses
facet '200 0 0' '300 0 0' '200 100 0' > elsewhere.stl
"$refuses" 'elsewhere.stl: 16 of 16 touches find no surface, at (13.3333, 0) mm, ' fettle-sample job.json --on elsewhere.stl
facet '0.005 0 0' '0.02 0 0' '0.005 0.03 0' > metres.stl
"$refuses" 'does not contain the job'"'s boundary: is its unit right?" fettle-sample job.json --on metres.stl
echo '1 1 1' > one.xyz
"$refuses" 'one.xyz: 16 of 16 touches find no surface' fettle-sample job.json --on one.xyz
# touched all the same, but said: mm taken for metres
fettle-sample job.json --on part.stl --on-units m 2> warning > samples.pcd
grep -qF "warning: part.stl: the part, 108000 x 108000 x 0 mm, is over 100 times as long" warning
# an output appears whole or not at all
! fettle-sample job.json --on elsewhere.stl -o out.pcd 2> /dev/null || exit 1
[ ! -e out.pcd ]
"$refuses" '/dev/full' fettle-sample job.json --on part.stl -o /dev/full
