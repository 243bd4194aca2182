# A laser profiler's raw list, profiles 1 to 12 mm apart with points every 0.3 mm, is joined along its order. Reference: the points themselves; every
# second profile's points lie on the mesh of the others, but for the waves between them.
zcat "$SAMPLES/scans/weld.txt.gz" | awk -F, '{ print 1000 * $1, 1000 * $2, 1000 * $3 }' > whole.xyz
awk 'NR > 1 && ($1 - x)^2 + ($2 - y)^2 + ($3 - z)^2 > 2500 { ++profile } { x = $1; y = $2; z = $3; print > (profile % 2 ? "odd.xyz" : "even.xyz") }' whole.xyz
fettle-reconstruct whole.xyz --report whole.json -o whole.stl
jq -e '.order == "profiles" and .left_out < 0.2 * .points and .open_borders < 20' whole.json > ok
fettle-reconstruct even.xyz --max-gap 50 --report even.json -o even.stl
jq -e '.order == "profiles"' even.json > ok
fettle-compare odd.xyz --to even.stl --max-distance 5 --report odd.json -o odd.pcd
jq -e '.rms < 0.5 and .count > 0.75 * (.count + .undefined)' odd.json > ok
