# What is removed under the operator's hand is the job's removal coefficient times the force, over the time of contact (Preston). Reference: the
# trace's forces, summed by awk, and the report. A force is that at the end of its 5 ms: 2 %.
fettle-part "$SAMPLES/parts/wang1.json" > part.stl
fettle-manual "$SAMPLES/jobs/wang1.json" --stock part.stl --machine "$SAMPLES/machines/full_scale.json" --steer "$SAMPLES/steering/h.txt" \
    --trace trace.pcd --report report.json --ascii > ground.pcd
awk -v c="$(jq .removal.coefficient "$SAMPLES/jobs/wang1.json")" '/^FIELDS/ { for (i = 2; i <= NF; ++i) at[$i] = i - 1 } /^DATA/ { body = 1; next }
    body { sum += c * ($at["force"] + last) / 2 * ($at["t"] - before); last = $at["force"]; before = $at["t"] }
    END { printf "{\"removed_volume\": %.9g}\n", sum }' trace.pcd > expected.json
jq '{removed_volume}' report.json | fettle-diff - expected.json --rel 0.02
