# A level surface of which only the height is uncertain, sigma 0.2 mm. Reference: quantiles of the normal distribution,
# one-sided for the shift, two-sided for the band; the tolerance is four standard errors of 8192 draws at 99 %.
cat > surface.json << 'JSON'
{"kind": "surface", "units": {"length": "mm"}, "shape": {"type": "plane", "origin": [0, 0], "z0": 5, "slope": [0, 0]},
 "covariance": [0.04, 0, 0, 0, 0, 0],
 "touches": [[0, 0, 5, 1], [20, 0, 5, 1], [0, 20, 5, 1]]}
JSON
echo '{"kind": "job", "units": {"length": "mm"}, "surface": {"type": "plane"},
  "anomaly": [[5, 5], [15, 5], [15, 15], [5, 15]]}' > job.json
fettle-margin job.json surface.json --report report.json > desired.json
jq -e '.shift - 0.2 * 2.3263 | fabs < 0.024' report.json
jq -e '.predicted_band - 0.2 * 2.5758 | fabs < 0.03' report.json
# the shift is in the surface, too, and raises it
jq -e --slurpfile report report.json '.shift == $report[0].shift and .predicted_band == $report[0].predicted_band' desired.json
# more confidence, more shift; less than half of it would be no margin
fettle-margin job.json surface.json --confidence 0.999 --report more.json > /dev/null
jq -e --slurpfile report report.json '.shift > $report[0].shift' more.json
# same input, same bytes; another seed, other draws
fettle-margin job.json surface.json | cmp - desired.json
if fettle-margin job.json surface.json --seed 5 | cmp -s - desired.json; then exit 1; fi
# a surface that has been shifted already is not shifted twice
fettle-margin job.json desired.json | cmp - desired.json
