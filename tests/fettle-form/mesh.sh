# The vertices of a mesh are points as those of a cloud are, and those of no facet are none.
printf 'v 11.5 7 1.1\nv 18.5 6.9 1.03\nv 4.5 13 1.02\nv 25.5 30 1.03\nv 11.5 37.5 1.02\nv 7 7 700\nf 1 2 3\nf 2 3 4\nf 3 4 5\n' >mesh.obj
sed -n 's/^v //p' mesh.obj | head -5 >points.xyz
for unit in mm in; do
    fettle-form flatness points.xyz --file-units $unit >points.json
    fettle-form flatness mesh.obj --file-units $unit >mesh.json 2>err
    fettle-diff points.json mesh.json
    [ "$(cat err)" = 'fettle-form: warning: mesh.obj: 1 vertex of no facet left out' ]
done
