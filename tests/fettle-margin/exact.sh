# A surface whose file says that it is known exactly has no band, and is not raised. Reference: the covariance, all zeros.
fettle-sample "$SAMPLES/jobs/hammer.json" --on "$SAMPLES/scans/hammer.stl" -q | fettle-fit "$SAMPLES/jobs/hammer.json" -m quadratic -q > fit.json
jq '.covariance |= map(0)' fit.json > exact.json
fettle-margin "$SAMPLES/jobs/hammer.json" exact.json > raised.json
jq -e '.shift == 0' raised.json > ok
