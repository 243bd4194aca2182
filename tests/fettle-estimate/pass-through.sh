# Planes and swept surfaces need no estimated points: their samples pass with every byte. Reference: identity.
job() { echo '{"kind": "job", "units": {"length": "mm"}, "surface": '"$1"', "anomaly": [[10, 10, 1], [20, 10, 1], [20, 20, 1], [10, 20, 1]],
  "sampling": [[0, 0], [30, 0], [30, 30], [0, 30]]}'; }
job '{"type": "plane"}' > plane.json
job '{"type": "swept", "direction_deg": 30}' > swept.json
for surface in plane swept; do
    fettle-sample $surface.json --plan-only > samples.pcd
    fettle-estimate $surface.json samples.pcd | cmp samples.pcd -
done
