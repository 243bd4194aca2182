# What is left out of a stock or a design, and a size that can hardly be meant, is said; what is left counts.
# Reference: the mesh without the facet.
printf 'OFF\n5 4 0\n0 0 9\n30 0 9\n30 20 9\n0 20 9\n15 10 nan\n3 0 1 2\n3 0 2 3\n3 1 4 2\n3 0 1 2\n' > gaps.off
printf 'OFF\n4 2 0\n0 0 9\n30 0 9\n30 20 9\n0 20 9\n3 0 1 2\n3 0 2 3\n' > whole.off
printf '5 5 6\n25 15 6\n' > path.xyz
fettle-mill path.xyz --stock gaps.off --cutter ball:6 --step 0.5 2> message > gaps.stl
grep -qF 'warning: gaps.off: 1 facet with NaN or infinite corners left out' message
fettle-mill path.xyz --stock whole.off --cutter ball:6 --step 0.5 | cmp - gaps.stl
fettle-mill path.xyz --stock whole.off --design gaps.off --cutter ball:6 --tolerance 0.1 2> message > design.stl
grep -qF 'warning: gaps.off: 1 facet with NaN or infinite corners left out' message
awk 'NF == 3 && NR > 2 { print $1 / 1000, $2 / 1000, $3 / 1000; next } { print }' whole.off > metres.off
fettle-mill path.xyz --stock metres.off --cutter ball:6 --step 0.005 2> message > small.stl
grep -qF 'metres.off: the stock, 0.03 x 0.02 x 0 mm, is less than 0.2 times as long as the cutter' message
fettle-mill path.xyz --stock metres.off --stock-units m --cutter ball:6 --step 0.5 2> message | fettle-diff --tol 1e-6 - gaps.stl
[ ! -s message ]
# A closed design that is inside out is turned over: the same step as of the right one. One facet of it alone faces up.
prism() { # "3 a b c": how its facets are wound
    printf 'OFF\n6 8 0\n0 0 0\n30 0 0\n0 20 0\n0 0 9\n30 0 5\n0 20 5\n'
    printf '0 2 1\n3 4 5\n0 1 4\n0 4 3\n1 2 5\n1 5 4\n2 0 3\n2 3 5\n' | awk "{ print $1 }"
}
prism '3, $1, $2, $3' > right.off
prism '3, $2, $1, $3' > wrong.off
how=(--stock box:0,0,0,30,20,9 --cutter ball:6 --tolerance 0.01)
fettle-mill path.xyz "${how[@]}" --design right.off --report right.json > right.stl
fettle-mill path.xyz "${how[@]}" --design wrong.off --report wrong.json 2> message > wrong.stl
grep -qF 'wrong.off: 8 facets that were wound inwards are turned over' message
jq -e --slurpfile b wrong.json '.discretization == $b[0].discretization and .discretization.slope_deg > 5' right.json > ok
