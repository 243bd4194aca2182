# What cannot be cleaned, or is asked for wrongly: status 2 and one line that names it.
refuses() { "$HERE/../refuses" "$1" fettle-clean "${@:2}"; }
printf '0 0 1\n1 0 1\n2 0 1\n3 0 1\n' > row.xyz
printf 'OFF\n3 1 0\n0 0 0\n9 0 0\n0 9 0\n3 0 1 2\n' > facet.off
refuses 'missing.pcd: cannot open' missing.pcd
: > empty
refuses 'empty: ' empty
printf 'nan 0 0\nnan 1 0\n' > none.xyz
refuses 'none.xyz: nothing is left: 2 invalid' none.xyz
refuses 'row.xyz: nothing is left: 0 invalid, 0 at origin, 0 duplicates, 4 cropped' row.xyz --crop box:0,0,5,9,9,9
refuses 'facet.off: nothing is left: 0 duplicates, 1 facing away' facet.off --facing 0,0,-1
refuses '--facing: the cloud has no normals' row.xyz --facing 0,0,1
refuses '--facing: a direction is not 0,0,0' row.xyz --facing 0,0,0
refuses "--facing: expected X,Y,Z, got '1,2'" row.xyz --facing 1,2
refuses '--thin: goes with clouds' facet.off --thin 1
refuses '--thin: ' row.xyz --thin 0
refuses '--thin: the points extend over more than 2^20 times this length' row.xyz --thin 1e-9
refuses '--outliers: 8 neighbours of each point are asked for, among 4 points' row.xyz --outliers statistical:8,1
refuses "--outliers: expected statistical:K,S or radius:R,N, got 'few'" row.xyz --outliers few
refuses "--outliers: expected 2 numbers after radius:, got 'radius:1'" row.xyz --outliers radius:1
refuses '--outliers: ' row.xyz --outliers radius:-1,3
refuses '--outliers: ' row.xyz --outliers statistical:0,3
refuses '--crop: expected box:X0,Y0,Z0,X1,Y1,Z1, got 2 numbers' row.xyz --crop box:1,2
refuses "--crop: 'one' is not a number" row.xyz --crop box:one,2,3,4,5,6
refuses '--crop: X0, Y0, Z0 of a box must be less' row.xyz --crop box:1,2,3,1,5,6
refuses '--crop: expected sphere:X,Y,Z,RADIUS, got 3 numbers' row.xyz --crop sphere:1,2,3
refuses '--crop: expected polygon:Z0,Z1,X1,Y1,X2,Y2,X3,Y3,…, got 7 numbers' row.xyz --crop polygon:0,1,0,0,1,0,0
refuses '--crop: the radius of a sphere must be positive' row.xyz --crop sphere:1,2,3,-1
refuses '--crop: Z0 of a polygon must be less than Z1' row.xyz --crop polygon:1,1,0,0,1,0,0,1
refuses 'nowhere.json: cannot open' row.xyz --crop nowhere.json
refuses 'left.stl: a cloud is written as PCD, PLY, CSV or VTK, not as stl' row.xyz -o left.stl
refuses 'left.pcd: a mesh is written as STL or PLY, not as pcd' facet.off -o left.pcd
refuses '--format: a mesh is written as STL or PLY, not as csv' facet.off --format csv
refuses "left.ply: '.ply' is not the suffix of --format pcd" row.xyz -o left.ply --format pcd
refuses '--ascii: goes with PCD' row.xyz --ascii --format ply
[ ! -e left.stl ]
[ ! -e left.pcd ]
[ ! -e left.ply ]
# What begins with a digit is no suffix of a format.
fettle-clean row.xyz --ascii -q -o left.2024
grep -q '^DATA ascii$' left.2024
