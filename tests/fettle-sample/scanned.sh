# Touches of a real scan lie on it. Reference: independent code, the closest point of fettle-compare; 1e-3 mm covers the
# float coordinates of samples and scan.
fettle-sample "$SAMPLES/jobs/hammer.json" --on "$SAMPLES/scans/hammer.stl" --report sample.json > samples.pcd
fettle-compare samples.pcd --to "$SAMPLES/scans/hammer.stl" --report compare.json > errors.pcd
jq -e --slurpfile s sample.json '.count == $s[0].touches and .undefined == 0 and .max < 1e-3 and .min > -1e-3' compare.json
