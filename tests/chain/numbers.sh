# Numbers that no part or job has, in every format: refused where they are read, in one line that names the place, not
# carried along until they overflow. Reference: the rules of every tool.
refuses=$HERE/../refuses
job=$SAMPLES/jobs/wang1.json part=$SAMPLES/parts/wang1.json
fettle-part "$part" -o part.stl
far="no part reaches that far"
printf '0 0 0\n1e300 0 0\n0 1e300 0\n' >far.xyz
printf 'v 0 0 0\nv 1e300 0 0\nv 0 1e300 0\nf 1 2 3\n' >far.obj
"$refuses" "far.xyz: point 1: $far: 1e+300 mm" fettle-form flatness far.xyz
for file in far.xyz far.obj; do
    "$refuses" "$file: point 1: $far" fettle-sample "$job" --on $file
    "$refuses" "$file: point 1: $far" fettle-compare $file --to part.stl
    "$refuses" "$file: point 1: $far" fettle-compare part.stl --to $file
    "$refuses" "$file: point 1: $far" fettle-render $file
done
echo '1e7 1e7 1' >survey.xyz # far, but read
fettle-compare survey.xyz --to survey.xyz -q >/dev/null || [ $? = 1 ] # one point has no error
# columns: one named like an axis, more than any scanner writes
printf 'x y z x\n1 2 3 4\n' >axis.xyz
"$refuses" "axis.xyz: column 'x' is duplicated" fettle-form flatness axis.xyz
printf '1 %.0s' {1..2000} >wide.xyz
"$refuses" 'wide.xyz: 2000 columns, at most 1000' fettle-form flatness wide.xyz
# JSON
surface() { echo '{"kind": "surface", "units": {"length": "mm"}, "shape": '"$1"'}'; }
surface '{"type": "plane", "origin": [0, 0], "z0": 1e308, "slope": [0, 0]}' >z0.json
surface '{"type": "plane", "origin": [0, -1e200], "z0": 1, "slope": [0, 0]}' >origin.json
surface '{"type": "griddata", "points": [], "spacing": 0, "angle_deg": 0}' >points.json
"$refuses" 'z0.json: shape.z0: no number may be as large as 1e+308' fettle-margin "$job" z0.json
"$refuses" 'origin.json: shape.origin[1]: no number may be as large as -1e+200' fettle-plan "$job" origin.json
"$refuses" 'points.json: shape.points: ' fettle-margin "$job" points.json
jq '.force.stiffness = 1e-300' "$job" >soft.json
"$refuses" 'soft.json: force.stiffness: too small: 1e-300' fettle-sample soft.json
jq --arg key "$(printf 'k%.0s' {1..1000})" '.[$key] = 1' "$job" >key.json
"$refuses" 'kkk...: unknown key' fettle-sample key.json
