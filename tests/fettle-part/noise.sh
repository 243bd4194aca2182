# Noise of ±0.01 in on a plane. Reference: the range of 10201 uniform numbers, 0.02 less 2e-6 on average; the fit takes off a little.
jq '.noise = "uniform:0.01"' "$SAMPLES/parts/wang1.json" >noisy.json
jq '.noise = "uniform:0.01" | .anomalies = []' "$SAMPLES/parts/wang1.json" | fettle-part --cloud |
    fettle-form flatness | jq -e '.least_squares > 0.0196 and .least_squares < 0.0202' >/dev/null
# The truth has none.
cmp <(fettle-part --without-anomaly noisy.json) <(fettle-part --without-anomaly "$SAMPLES/parts/wang1.json")
