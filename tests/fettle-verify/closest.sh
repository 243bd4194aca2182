# The closest point beside the patches: on a plane both are the same; before a wall of 60 degrees, with the material left
# level, the patch method says more than is left, and the report says where. Reference: a plane 0.1 mm off; at the foot of
# the slope the patch error is half of Z's, the distance to the level plane is less.
# shellcheck source=tests/fettle-verify/offset.bash
. "$HERE/offset.bash"
ramp 0.5 0 -2 12 3 > design.off
ramp 0.5 0.1 0 10 20 > part.off
fettle-verify part.off --design design.off --method closest --tolerance 0.2 --report plane.json --csv plane.csv > plane.pcd
jq -e '.method == "closest" and .patch_minus_closest.to_45_deg.count == 800 and .patch_minus_closest.to_45_deg.max_abs < 1e-9 and
       .patch_minus_closest.steeper.count == 0' plane.json > ok
head -n 1 plane.csv
valley() { # LIFT: level to x = 5, then up at 60 degrees
    ramp 0 0 "$2" "$3" "$4" | awk -v lift="$1" -v CONVFMT=%.15g 'NF == 3 && NR > 2 { $3 = lift + ($1 > 5 ? 1.7320508 * ($1 - 5) : 0) } { print }'
}
valley 0 -2 12 28 > design.off
valley 1 0 10 20 > part.off
fettle-verify part.off --design design.off --method closest --tolerance 2 --report valley.json > valley.pcd
# Material 1 mm high in Z on the slope: 0.5 mm by the patch and, far from the foot, by the closest point; none is farther
# from the design than from its level plane or its slope.
jq -e '.patch_minus_closest.steeper.count == 400 and .patch_minus_closest.steeper.max_abs < 1e-6 and
       .patch_minus_closest.to_45_deg.max_abs > 0.1 and .patch_minus_closest.to_45_deg.max_at[0] > 4 and
       .patch_minus_closest.to_45_deg.max_at[0] < 5' valley.json > ok
