# What cannot become a mesh, or is asked for wrongly: status 2 and one line that names it.
refuses() { "$HERE/../refuses" "$1" fettle-reconstruct "${@:2}"; }
printf '0 0 1\n90 0 1\n0 90 1\n90 90 2\n' > far.xyz
printf 'OFF\n3 1 0\n0 0 0\n9 0 0\n0 9 0\n3 0 1 2\n' > facet.off
refuses 'missing.pcd: cannot open' missing.pcd
: > empty
refuses 'empty: ' empty
printf '1 1 1\n1 1 1\nnan 1 1\n' > same.xyz
n=20000001
printf 'VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH %d\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS %d\nDATA binary\n' $n $n > large.pcd
truncate -s "+$((12 * n))" large.pcd
refuses 'large.pcd: 20000001 points are more than can be joined, 20 million: thin them first' large.pcd
refuses 'same.xyz: 1 different points, three are needed' same.xyz
refuses 'far.xyz: no three points lie within the gap of 5 mm' far.xyz --max-gap 5
refuses 'facet.off: is a mesh already' facet.off
refuses '--max-gap: ' far.xyz --max-gap 0
refuses '--facing: a direction is not 0,0,0' far.xyz --facing 0,0,0
refuses '--facing: goes without --from' far.xyz --facing 0,0,1 --from 0,0,9
refuses '--from: ' far.xyz --from 1,2
refuses "mesh.pcd: '.pcd' is no format of this output: .stl, .ply" far.xyz -o mesh.pcd
[ ! -e mesh.pcd ]
