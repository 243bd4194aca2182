# E57 scans: floats, scaled integers of 20 bits, spherical coordinates; poses, colours, invalid points. Reference: the points that tests/write-e57, a
# program of its own in Python, was given.
awk 'BEGIN { for (i = 0; i < 400; ++i) printf "%.4f %.4f %.4f %.3f %d %d %d %d\n", cos(i) * 2, sin(i) * 2 + 1, i / 100, i / 1000, i % 256, 255 - i % 256, 7, i % 9 == 8 ? 2 : 0 }' > points.txt
awk '$8 == 0 { print $1, $2, $3 }' points.txt > valid.xyz
points_of() { sed '1,/^DATA/d' "$1" | cut -d ' ' -f 1-3; }
for type in double single scaled spherical; do
    "$HERE/../write-e57" $type.e57 $type points.txt
    fettle-clean $type.e57 --ascii --report $type.json > $type.pcd
    jq -e '.points == 400 and .invalid == 44 and .duplicates == 0' $type.json > ok
    points_of $type.pcd > $type.xyz
    fettle-diff --tol 2e-5 <(fettle-clean $type.xyz) <(fettle-clean valid.xyz)
done
grep -q '^# units m$' single.pcd
grep -q '^FIELDS x y z intensity rgb$' single.pcd
sed '1,/^DATA/d' single.pcd | sed -n 8p | grep -qE ' 0.007[0-9]* 522247$' # 7, 248, 7
# Two scans in a file, the first of them turned by 90 degrees about z and shifted. Of one scan the scanner is the viewpoint, if its pose is stated; two have none.
printf '1 0 0\n2 0 0\n1 1 0\n' > a.txt
printf '5 6 7\n5 6 8\n' > b.txt
"$HERE/../write-e57" two.e57 double pose=0.7071067811865476,0,0,0.7071067811865476,10,20,30 a.txt b.txt
fettle-place two.e57 --format ply > two.ply
view() { fettle-place "$1" | grep -a -m 1 '^VIEWPOINT'; }
[ "$(view two.e57)" = 'VIEWPOINT 0 0 0 1 0 0 0' ]
"$HERE/../write-e57" one.e57 double pose=0.7071067811865476,0,0,0.7071067811865476,10,20,30 a.txt
view one.e57 | grep -q '^VIEWPOINT 10 20 30 0.70'
"$HERE/../write-e57" still.e57 double pose=1,0,0,0,0,0,0 a.txt
[ "$(view still.e57)" = 'VIEWPOINT 0 0 0 -1 0 0 0' ]
[ "$(view double.e57)" = 'VIEWPOINT 0 0 0 1 0 0 0' ]
printf '10 21 30\n10 22 30\n9 21 30\n5 6 7\n5 6 8\n' > two.xyz
fettle-clean two.e57 --ascii > two.txt
fettle-diff --tol 1e-5 <(points_of two.txt) two.xyz
# Compressed, in another unit, and from a pipe it is the same.
gzip -k two.e57
fettle-place - --units mm < two.e57.gz > piped.pcd
fettle-place two.e57 --units mm | cmp - piped.pcd
# Normals turn with their scan, and are not shifted.
printf '1 0 0 1 0 0\n2 0 0 0 0.6 0.8\n' > normals.txt
"$HERE/../write-e57" normals.e57 double pose=0.7071067811865476,0,0,0.7071067811865476,10,20,30 normals.txt
fettle-clean normals.e57 --ascii > normals.pcd
grep -q '^FIELDS x y z normal_x normal_y normal_z$' normals.pcd
printf '0 1 0\n-0.6 0 0.8\n' > turned.xyz
sed '1,/^DATA/d' normals.pcd | cut -d ' ' -f 4-6 | fettle-diff --tol 1e-6 - turned.xyz
