# What cannot be predicted, or is no surface, no job, no command line.
refuses=$HERE/../refuses
surface() { echo '{"kind": "surface", "units": {"length": "mm"}, "shape": {"type": "plane", "origin": [0, 0], "z0": 5, "slope": [0, 0]}, '"$1"' "touches": [[0, 0, 5, 1], [20, 0, 5, 1], [0, 20, 5, 1]]}'; }
surface '"covariance": [0.04, 0, 0, 0, 0, 0],' > surface.json
surface '' > unknown.json
echo '{"kind": "job", "units": {"length": "mm"}, "surface": {"type": "plane"},
  "anomaly": [[5, 5], [15, 5], [15, 15], [5, 15]]}' > job.json
sed 's/plane/freeform/' job.json | sed 's/"anomaly"/"sampling": [[0, 0], [20, 0], [20, 20], [0, 20]], "anomaly"/' > freeform.json
: > empty
"$refuses" 'empty: empty, expected JSON' fettle-margin job.json empty
"$refuses" 'empty: empty, expected JSON' fettle-margin empty surface.json
"$refuses" 'job.json: kind: expected "surface"' fettle-margin job.json job.json
"$refuses" 'surface.json: kind: expected "job"' fettle-margin surface.json surface.json
"$refuses" 'nowhere.json' fettle-margin job.json nowhere.json
"$refuses" 'unknown.json: the surface has no covariance' fettle-margin job.json unknown.json
"$refuses" 'surface.json: Wang'"'s regressions need 4 touches" fettle-margin freeform.json surface.json --method wang
"$refuses" '--confidence' fettle-margin job.json surface.json --confidence 1
"$refuses" '--confidence' fettle-margin job.json surface.json --confidence nan
"$refuses" '--method' fettle-margin job.json surface.json --method guess
"$refuses" '/dev/full' fettle-margin job.json surface.json -o /dev/full
# a surface that ends inside the anomaly
jq '.shape = {"type": "griddata", "points": [[0, 0, 5], [10, 0, 5], [0, 10, 5]], "spacing": 0, "angle_deg": 0}' \
    surface.json > short.json
"$refuses" 'short.json: the surface does not cover the anomaly: it is not defined at (15, 5) mm' fettle-margin job.json short.json
# all of the probability is with a shape that ends inside the anomaly
jq '.fit = {"method": "plane", "touch_sigma": 0.05, "rms": 0, "ignored": 0, "weight": 0} | .alternatives = [{"method": "short", "score": 0,
    "weight": 1, "shape": {"type": "griddata", "points": [[0, 0, 5], [10, 0, 5], [0, 10, 5]], "spacing": 0, "angle_deg": 0},
    "covariance": [1, 0, 0, 0, 0, 0]}]' surface.json > elsewhere.json
"$refuses" 'touches: the surface fitted to them has no covariance that is finite all over the anomaly' fettle-margin job.json elsewhere.json
