# Wang's regressions through the chain. Reference: his convex rows by hand for a sphere of 4 in: curvature 1/4, area
# 2 x 2, and the outer touches 1.45 in (in x) off the anomaly. The noiseless touches lie on the sphere: variance 0.
cat > part.json << 'JSON'
{"kind": "part", "units": {"length": "in"}, "surface": {"type": "sphere", "centre": [2.5, 2, 0], "radius": 4},
 "region": {"x": [0, 5], "y": [0, 4]}, "step": 0.02, "anomalies": []}
JSON
sed 's/"anomaly".*/"anomaly": [[1.5, 1], [3.5, 1], [3.5, 3], [1.5, 3]],/' "$SAMPLES/jobs/patch_convex_2x2.json" > job.json
fettle-part part.json -o part.stl
fettle-sample job.json --on part.stl | fettle-fit job.json > surface.json
fettle-margin job.json surface.json --method wang --report report.json > /dev/null
jq -e '.predicted_band - (.3340 / 4 + .0028 * 4 + .0013 * 1.45 - .0127) | fabs < 2e-4' report.json
jq -e '.shift - (.2386 / 4 + .0024 * 4 + .0007 * 1.45 - .0098) | fabs < 2e-4' report.json
jq -e '.clamped == false and .method == "wang"' report.json
