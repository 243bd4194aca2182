# Killed at any moment, 20 times on each machine, a run leaves a trace whose points are the beginning of
# what an undisturbed run does. --resume continues: nothing is repeated but the step that was under way, and
# the part comes out as it should, within the tolerance of 0.1 and not below the plane by more than 0.01. The driver's machine keeps its
# stock. References: the undisturbed run, and the plane. With FETTLE_DRAWS=few (make test) five times on each machine.
# shellcheck source=tests/fettle-grind/stock.bash
. "$HERE/stock.bash"
make_job 0
make_stock 4
machine="--machine $SAMPLES/machines/full_scale.json"
rows() { # that the header counts: after them there may be a part of one more
    awk '/^POINTS/ { n = $2 } body && n-- > 0 { sub(/ *$/, ""); print } /^DATA/ { body = 1 }' "$1"
}
first() { awk -v n="$1" 'NR <= n'; }
length_ground() { rows "$1" | awk '{ if ($9 > 0) s += sqrt(($1 - x) ^ 2 + ($2 - y) ^ 2); x = $1; y = $2 } END { print s }'; }
flat() { # the ground part
    awk '/^DATA/ { body = 1; next } body && $1 > -6 && $1 < 6 && $2 > -6 && $2 < 6 { if ($3 > 5.1 || $3 < 5 - 0.01) bad++; n++ }
        END { exit bad > 0 || n != 60 * 60 }' "$1"
}
RANDOM=1
times=20
[ "${FETTLE_DRAWS:-all}" = all ] || times=5
for kind in virtual virtual:dynamic exec; do
    options=()
    [ $kind = virtual ] || options=(--machine "$SAMPLES/machines/full_scale.json")
    gantry=$kind
    [ $kind != exec ] || options=() gantry="exec:exec fettle-gantry-virtual plan.json --stock stock.stl --cell 0.2 $machine --ground left.pcd"
    begun=$(date +%s%N)
    fettle-grind plan.json --stock stock.stl --cell 0.2 --gantry "$gantry" "${options[@]}" --layer-1 feed --trace whole.pcd --ascii > ground.pcd
    took=$(( ($(date +%s%N) - begun) / 1000000 )) # ms
    for ((n = 0; n < times; n++)); do
        rm -f left.pcd trace.pcd
        fettle-grind plan.json --stock stock.stl --cell 0.2 --gantry "$gantry" "${options[@]}" --layer-1 feed --trace trace.pcd --ascii > ground.pcd &
        sleep "$(awk -v t=$took -v r=$RANDOM 'BEGIN { print t * (r % 1000) / 1000 / 1000 }')"
        kill -9 $! 2> killed || true
        wait $! 2> killed || true
        [ -e trace.pcd ] || continue # it had not begun
        rows trace.pcd | awk '$7 != 13' > done
        rows whole.pcd | first "$(wc -l < done)" | cmp - done
        again=$gantry
        if [ $kind = exec ]; then
            for _ in {1..100}; do [ -s left.pcd ] && break || sleep 0.05; done
            left=left.pcd
            [ -s left.pcd ] || { [ ! -s done ] && left=stock.stl; } # the driver had not begun either
            again="exec:exec fettle-gantry-virtual plan.json --stock $left --cell 0.2 $machine --ground truth.pcd"
        fi
        fettle-grind plan.json --stock stock.stl --cell 0.2 --gantry "$again" "${options[@]}" --layer-1 feed --resume trace.pcd --report report.json --ascii > ground.pcd
        jq -e .finished report.json > ok
        flat ground.pcd
        rows trace.pcd | first "$(wc -l < done)" | cmp - done
        awk -v a="$(length_ground trace.pcd)" -v b="$(length_ground whole.pcd)" 'BEGIN { exit a > 1.03 * b }' # readings differ
    done
done

# What goes on is the same run: another plan, other options and what is no trace are refused.
"$HERE/../refuses" 'does not match this plan and these options' fettle-grind plan.json --stock stock.stl --resume whole.pcd
jq '.passes |= .[:-1]' plan.json > other.json
"$HERE/../refuses" 'does not match this plan and these options' fettle-grind other.json --stock stock.stl --layer-1 feed --resume whole.pcd
"$HERE/../refuses" 'ground.pcd: ' fettle-grind plan.json --stock stock.stl --resume ground.pcd
"$HERE/../refuses" 'none.pcd: cannot open' fettle-grind plan.json --stock stock.stl --resume none.pcd

# What is finished stays as it is.
cp whole.pcd again.pcd
fettle-grind plan.json --stock stock.stl --cell 0.2 --layer-1 feed --resume again.pcd --ascii > ground.pcd
fettle-diff --tol 1e-6 whole.pcd again.pcd
flat ground.pcd
