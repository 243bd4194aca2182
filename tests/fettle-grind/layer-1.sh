# Feed-rate control and force control: the hill is ground in one covering, in soft and in hard stock, on both gantries, to the
# plane within the tolerance and not below it by more than 0.01; without it takes several. The margins of the loops are reported, and
# no smaller than promised: 3 and 38.9 degrees. References: the plane, and the runs without.
# shellcheck source=tests/fettle-grind/stock.bash
. "$HERE/stock.bash"
make_job 0
make_stock 4
for gantry in virtual virtual:dynamic; do
    machine=()
    [ $gantry = virtual ] || machine=(--machine "$SAMPLES/machines/full_scale.json")
    for factor in 0.5 1.5; do
        for control in constant feed force; do
            fettle-grind plan.json --stock stock.stl --cell 0.1 --gantry $gantry "${machine[@]}" --removal-factor $factor \
                --layer-1 $control --report $control.json --ascii > $control.pcd
        done
        for control in feed force; do
            jq -e -n --slurpfile a constant.json --slurpfile b $control.json '$a[0].coverings > 1 and $a[0].strokes == 0 and
                $b[0].coverings == 1 and $b[0].strokes > 0 and $b[0].machine_time < $a[0].machine_time' > ok
            awk '/^DATA/ { body = 1; next }
                body && $1 > -6 && $1 < 6 && $2 > -6 && $2 < 6 { if ($3 > 5.1 || $3 < 5 - 0.01) bad++; n++ }
                END { exit bad > 0 || n != 120 * 120 }' $control.pcd
        done
    done
done
jq -e '[.loops[] | select(.gain_margin >= 3 and .phase_margin_deg >= 38.9)] | length == 6' force.json > ok
