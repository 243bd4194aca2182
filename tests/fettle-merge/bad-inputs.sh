# What cannot be merged: status 2 and one line that names the file.
refuses() { "$HERE/../refuses" "$1" fettle-merge "${@:2}"; }
cp "$SAMPLES"/scans/views/[123].pcd .
refuses 'needs two scans or more, got 1' 1.pcd
refuses 'missing.pcd: cannot open' 1.pcd missing.pcd
printf 'VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 0\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 0\nDATA ascii\n' >empty.pcd
refuses 'empty.pcd: ' 1.pcd empty.pcd
for i in $(seq 200); do echo nan nan nan; done >nan.xyz
refuses 'nan.xyz: nothing is left: 200 invalid' 1.pcd nan.xyz
n=20000001
printf 'VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH %d\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS %d\nDATA binary\n' $n $n >large.pcd
truncate -s "+$((12 * n))" large.pcd
refuses 'large.pcd: has 20000001 points, more than the 20 million of a scan that can be merged: thin it first' large.pcd 1.pcd
rm large.pcd
seq 900 | awk '{ print $1 % 30 / 1000, int($1 / 30) / 1000, 0 } END { print 9000, 0, 0 }' >wide.xyz
refuses 'wide.xyz: the points extend over more than 2^20 times their distance from each other' wide.xyz wide.xyz
seq 50 | awk '{ print $1, $1 % 7, $1 % 5 }' >few.xyz
refuses 'few.xyz: has 50 points; 100 are needed' few.xyz 1.pcd
seq 2000 | awk '{ print $1 / 10, 0, sin($1 / 100) }' >profile.xyz
refuses 'profile.xyz: shows no surface' 1.pcd profile.xyz
fettle-place "$SAMPLES/scans/panel.pcd" --units mm --centre -o panel.pcd
fettle-clean panel.pcd --crop sphere:0,0,0,40 -o foreign.pcd
refuses "no two of the scans fit each other" 1.pcd foreign.pcd
# In metres, without a word of it: what is odd about the files is said with it.
for k in 1 2; do fettle-clean $k.pcd --format csv -q | awk -F , 'NR > 1 { print $1 / 1000, $2 / 1000, $3 / 1000 }' >m$k.xyz; done
refuses 'is under 5 mm long: is its unit right' m1.xyz m2.xyz
refuses 'poses.json: ' --poses poses.json 1.pcd 2.pcd
echo '{"kind": "poses", "units": {"length": "mm"}, "scans": [{"file": "1.pcd", "matrix": [[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]}]}' >poses.json
refuses 'poses.json: scans: none of them is 2.pcd' --poses poses.json 1.pcd 2.pcd
echo '{"kind": "poses", "units": {"length": "mm"}, "scans": [{"file": "1.pcd", "matrix": [[2,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]}]}' >poses.json
refuses 'is not a rotation and a translation' --poses poses.json 1.pcd 2.pcd
refuses "'.stl' is no format of this output: .pcd, .ply, .csv, .vtk" 1.pcd 2.pcd -o out.stl
[ ! -e out.stl ]

# NaN blocks in a scan are left out. Reference: the scan without them.
fettle-clean 2.pcd --ascii >2.txt
awk '/^DATA/ { data = 1 } { print } data && NR % 5 == 0 { print "nan nan nan"; ++added }' 2.txt >holes.txt
count=$(grep -c -v '^[#A-Z]' holes.txt)
sed -i "s/^WIDTH .*/WIDTH $count/; s/^POINTS .*/POINTS $count/" holes.txt
fettle-merge 3.pcd 2.txt --report a.json -o a.pcd
fettle-merge 3.pcd holes.txt --report b.json -o b.pcd
cmp a.pcd b.pcd
