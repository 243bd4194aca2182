# Shift and band of a level surface whose height alone is uncertain, sigma 0.2 mm, at four confidences. Reference: the normal distribution's
# one-sided and two-sided quantiles, by Newton's method on python's erf. Tolerance: at confidence c a quantile of 8192 draws has the standard
# error sqrt(c (1 - c) / 8192) over the density there; four of them at 99 % are 0.033 mm, at lower confidences less.
cat > surface.json << 'JSON'
{"kind": "surface", "units": {"length": "mm"}, "shape": {"type": "plane", "origin": [0, 0], "z0": 5, "slope": [0, 0]},
 "covariance": [0.04, 0, 0, 0, 0, 0], "touches": [[0, 0, 5, 1], [20, 0, 5, 1], [0, 20, 5, 1]]}
JSON
echo '{"kind": "job", "units": {"length": "mm"}, "surface": {"type": "plane"}, "anomaly": [[5, 5], [15, 5], [15, 15], [5, 15]]}' > job.json
for confidence in 0.8 0.9 0.95 0.99; do
    fettle-margin job.json surface.json --confidence $confidence --report report.json > desired.json
    python3 - $confidence > expected.json << 'PYTHON'
import json, math, sys
def quantile(p):
    x = 0.0
    for _ in range(60):
        x -= (0.5 * (1 + math.erf(x / math.sqrt(2))) - p) / (math.exp(-x * x / 2) / math.sqrt(2 * math.pi))
    return x
c = float(sys.argv[1])
print(json.dumps({"shift": 0.2 * quantile(c), "predicted_band": 0.2 * quantile((1 + c) / 2)}))
PYTHON
    jq '{shift, predicted_band}' report.json | fettle-diff - expected.json --tol 0.033
done
