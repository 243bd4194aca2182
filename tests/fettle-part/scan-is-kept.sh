# The untouched scan is the truth: without anomalies it comes out as it was. Reference: the scan file itself.
fettle-part --without-anomaly "$SAMPLES/parts/hammer.json" -o truth.stl
fettle-diff "$SAMPLES/scans/hammer.stl" truth.stl
# With them, no vertex of the scan has sunk, and the cheek (24.4 to 25.1 mm high) has gained the bead.
fettle-part --cloud "$SAMPLES/parts/hammer.json" |
    fettle-compare - --to truth.stl --within "$SAMPLES/jobs/hammer.json" --mode z --report r.json >/dev/null || [ $? -eq 1 ]
jq -e '.regions.inside.max > 2 and .regions.inside.max < 3 and .regions.around.max < 1e-4 and .min > -1e-4' r.json >/dev/null
