# Work in inches and pounds gives what it does in millimetres and newtons. Reference: the identity 1 in = 25.4 mm, 1 lbf =
# 4.4482216152605 N.
# shellcheck source=tests/fettle-grind/stock.bash
. "$HERE/stock.bash"
make_job 0
make_stock 4
fettle-grind plan.json --stock stock.stl --cell 0.2 --report mm.json > mm.pcd
jq '25.4 as $l | 4.4482216152605 as $f | .units = {length: "in", force: "lbf"} | .anomaly |= map(map(. / $l)) |
    .tolerance /= $l | .safe_height /= $l | .wheel |= map_values(. / $l) | .force.stiffness *= $l |
    .force |= map_values(. / $f) | .feed |= map_values(. / $l) | .removal.coefficient *= $f / ($l * $l * $l)' job.json > in-job.json
jq '.units.length = "in" | .shape.z0 /= 25.4' surface.json > in-surface.json
fettle-plan in-job.json in-surface.json > in-plan.json
fettle-grind in-plan.json --stock stock.stl --stock-units mm --cell "$(jq -n '0.2 / 25.4')" --report in.json > in.pcd
jq -e -n --slurpfile a mm.json --slurpfile b in.json '$a[0] as $a | $b[0] as $b |
    ($a.removed_volume / $b.removed_volume / 25.4 / 25.4 / 25.4 - 1 | fabs) < 1e-6 and
    ($a.peak_force / $b.peak_force / 4.4482216152605 - 1 | fabs) < 1e-6 and
    ($a.machine_time - $b.machine_time | fabs) < 1e-3 and $a.steps == $b.steps' > ok
