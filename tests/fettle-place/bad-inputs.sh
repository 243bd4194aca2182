# What cannot be moved, or is asked for wrongly: status 2 and one line that names it.
refuses() { "$HERE/../refuses" "$1" fettle-place "${@:2}"; }
printf '0 0 1\n1 0 1\n2 1 1\n3 0 1\n' > four.xyz
refuses 'missing.pcd: cannot open' missing.pcd
refuses 'none.txt: cannot open' four.xyz --matrix none.txt
printf '2 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n' > scale.txt
refuses 'scale.txt: is not a rotation' four.xyz --matrix scale.txt
printf -- '-1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n' > mirror.txt
refuses 'mirror.txt: is a reflection' four.xyz --matrix mirror.txt
refuses "--turn: expected AXIS,DEG,..., got 'z'" four.xyz --turn z
refuses "--turn: 'w' is none of" four.xyz --turn w,90
refuses '--turn: ' four.xyz --turn z,much
refuses 'nowhere.txt: cannot open' four.xyz --up nowhere.txt
printf '0,0,0\n1,1,1\n2,2,2\n' > line.txt
refuses 'four.xyz: a plane needs three picked points that are not on a line' four.xyz --up line.txt
refuses '--threshold: goes with --up plane or --up cylinder' four.xyz --threshold 1
printf '0 0 0\n5 0 0\n' > two.xyz
refuses 'two.xyz: has fewer than three points' two.xyz --up plane
printf 'nan 0 0\nnan 1 0\n' > none.xyz
refuses 'none.xyz: has fewer than three points' none.xyz --up plane
refuses 'out.stl: a cloud is written as PCD, PLY, CSV or VTK, not as stl' four.xyz -o out.stl
[ ! -e out.stl ]
# PCL's search complains of points that are all the same; here only the tool speaks.
for _ in $(seq 200); do echo 1 2 3; done > same.xyz
refuses 'same.xyz: ' same.xyz --up plane
# What it is built with: the point clouds' library by the version in the name of its file.
fettle-place --version | grep -q ', PCL [0-9]'
