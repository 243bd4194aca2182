# What cannot be shown: exit 2, one line, no page.
printf '1 2 3\n2 3 4\n3 1 5\n' >three.xyz
refuses() { "$HERE/../refuses" "$1" fettle-view "${@:2}"; }
refuses 'none.pcd: cannot open' none.pcd
refuses '--field: no file has a field' three.xyz --field sigma
refuses '--scale' three.xyz --scale 0
refuses 'kind' three.xyz --within "$SAMPLES/parts/wang1.json"
printf 'nan nan nan\nnan nan nan\n' >nan.xyz
refuses 'nan.xyz: no point has a finite x, y and z: there is nothing to draw' nan.xyz
fettle-view three.xyz -o three.html
test -s three.html
