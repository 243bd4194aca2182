# Held and undetermined motions keep their start values, and both are reported.
# Reference: the axes themselves; a plane leaves two shifts and one turn open.
awk 'BEGIN { for (i = 0; i < 40; i++) for (j = 0; j < 30; j++) print i, j, (i < 12 && j < 9 ? 6 : i > 30 ? 3 : 0) }' >steps.xyz
awk '{ print -$2 + 7, $1 - 3, $3 }' steps.xyz >turned.xyz
fettle-align turned.xyz --to steps.xyz --hold z,rx,ry --report r.json --ascii -q >back.pcd
jq -e '.transform[2] == [0, 0, 1, 0] and ([.degrees_of_freedom[] | select(.held)] | length) == 3 and .sd.z == 0' r.json >/dev/null
awk 'NR == FNR { x[NR] = $1; y[NR] = $2; next } data { n++; if (($1 - x[n])^2 + ($2 - y[n])^2 > 1e-4) exit 1 } $1 == "DATA" { data = 1 }' steps.xyz back.pcd

awk '{ print $1, $2, 0 }' steps.xyz >plane.xyz
awk '{ print $1 + 0.3, $2, 0.5 }' steps.xyz >above.xyz
fettle-align above.xyz --to plane.xyz --near --report r.json --ascii 2>err >back.pcd
grep -q 'not all of its motions are determined' err
jq -e '.determined == 3 and .sd.x == null and .sd.rz_deg == null and .sd.z < 1e-3 and
    (.transform[0][3] | fabs) < 1e-9 and (.transform[2][3] + 0.5 | fabs) < 1e-6' r.json >/dev/null
fettle-align above.xyz --to plane.xyz --near --hold z,rx --report r.json --ascii -q >back.pcd
jq -e '.determined == 1 and ([.degrees_of_freedom[] | select(.held)] | length) == 2 and .sd.z == 0 and .sd.x == null and
    ([.degrees_of_freedom[] | select(.held) | .shift + .turn | map(fabs) | add] == [1, 1])' r.json >/dev/null
