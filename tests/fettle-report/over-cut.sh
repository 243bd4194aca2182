# What the wheel cut is told from what the part lacked before it was ground, and the verdict is about the first. Reference: five points
# over a plate at z = 0, by hand. They end at 0.01, -0.015, -0.3, -0.25 and 0; the wheel took 1, 0.5, 0, 0.05 and 0.2 there: it over-cut
# by 0.015 at the second and by 0.05 at the fourth; the third lacked 0.3 before, the fourth 0.2.
printf 'x y z removed\n1 1 0.01 1\n2 1 -0.015 0.5\n3 1 -0.3 0\n4 1 -0.25 0.05\n5 1 0 0.2\n' >ground.xyz
printf 'v 0 0 0\nv 9 0 0\nv 9 9 0\nv 0 9 0\nf 1 2 3 4\n' >plate.obj
fettle-compare ground.xyz --to plate.obj --tolerance 0.06 --report errors.json -o errors.pcd && exit 1
page() { fettle-report --errors errors.pcd --comparison errors.json "$@"; }
figure() { sed -n "s/.*data-key=\"$1\" data-value=\"\([^\"]*\)\".*/\1/p" <<<"$(tr '<' '\n' <page.html)" | head -n 1; }
near() { awk -v a="$1" -v b="$2" 'BEGIN { exit !((a - b) ^ 2 < 1e-12) }'; }
page -o page.html --report page.json
grep -q 'data-verdict="Within tolerance"' page.html # 0.3 of the third are not the wheel's
near "$(figure over_cut.by_wheel)" 0.05
near "$(figure over_cut.lacked)" 0.3
near "$(figure judged.worst)" 0.05
grep -q '2 points lay below the reference before grinding' page.html
grep -q 'judged is what the wheel did, not what the part lacked already' page.html
jq -e '.verdict == "within" and (.worst - 0.05 | fabs) < 1e-6 and (.lacked - 0.3 | fabs) < 1e-6' page.json >/dev/null
page --judge all -o page.html --report page.json
grep -q 'data-verdict="Out of tolerance"' page.html
jq -e '.verdict == "out of tolerance" and (.worst - 0.3 | fabs) < 1e-6' page.json >/dev/null
# A map that does not know what was removed is judged as a whole.
fettle-compare <(cut -d ' ' -f 1-3 ground.xyz) --to plate.obj --tolerance 0.06 --report errors.json -o errors.pcd && exit 1
page -o page.html
grep -q 'data-verdict="Out of tolerance"' page.html
! grep -q 'over_cut.by_wheel' page.html || exit 1
