# The shift of a plane: the worst case of its touches, and the probe's accuracy as Wang published it (2007, 4.5). Reference: by hand, touches at
# the corners of the anomaly make the plane wrong by one and a half times the accuracy at the most.
echo '{"kind": "job", "units": {"length": "in"}, "surface": {"type": "plane"}, "probe": {"accuracy": 0.005},
  "anomaly": [[0, 0, 1], [2, 0, 1], [2, 2, 1], [0, 2, 1]]}' >job.json
fettle-sample job.json | fettle-fit job.json >surface.json
shift_of() { fettle-margin job.json surface.json --method wang "$@" --report report.json >desired.json; jq -c '[.shift, .predicted_band] | map(. * 1e6 | round / 1e6)' report.json; }
[ "$(shift_of)" = '[0.0075,0.01]' ]
[ "$(shift_of --plane-shift worst-case)" = '[0.0075,0.01]' ]
[ "$(shift_of --plane-shift accuracy)" = '[0.005,0.005]' ]
"$HERE/../refuses" '--plane-shift is for --method wang' fettle-margin job.json surface.json --plane-shift accuracy
