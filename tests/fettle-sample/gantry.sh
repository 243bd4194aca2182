# Touched by a machine through its driver: where a scan's touches are, within half a count of the drive's encoder (0.005 mm) and
# what a ball of 1.27 mm sinks between cells of 0.1 mm (0.1² / 8R: 0.001 mm), which a point does not. Adaptive touches
# are made one by one, and none twice. References: the touches on the scan; the number of the driver's answers.
fettle-part "$SAMPLES/parts/wang3.json" > part.stl
jq '.surface = {type: "freeform"}' "$SAMPLES/jobs/wang3.json" > job.json
driver="fettle-gantry-virtual $PWD/job.json --stock $PWD/part.stl"
for tip in 0 0.05; do
    fettle-sample job.json --strategy wang --tip $tip --on part.stl > scan.pcd
    jq ".probe.tip_radius = $tip" job.json > tip.json
    fettle-sample tip.json --strategy wang --on "gantry:exec:fettle-gantry-virtual $PWD/tip.json --stock $PWD/part.stl" > machine.pcd
    fettle-diff --tol 0.00014 scan.pcd machine.pcd # in: 0.0035 mm
done
fettle-sample job.json --strategy adaptive --max-touches 8 --report report.json -q \
    --on "gantry:exec:tee lines | $driver" > adaptive.pcd
touches=$(jq .touches report.json)
[ "$(grep -c ' probe ' lines)" -le $((touches + 2)) ]
[ "$(grep -c ' probe ' lines)" -ge "$touches" ]

# The head turns to θ before the first touch.
jq '.frame.theta_deg = 30' job.json > turned.json
fettle-sample turned.json --strategy wang --on "gantry:exec:tee turned | fettle-gantry-virtual $PWD/turned.json --stock $PWD/part.stl" > turned.pcd
awk '$2 == "home" { homed = $3 > 0.5235 && $3 < 0.5237 } $2 == "probe" { n++; if (!homed) exit 1 } END { exit n < 10 }' turned

# A place without material is no touch; a machine has no unit and no noise of the user's.
jq '.sampling[1] = [40, 0.1, 0.4722]' job.json > far.json
"$HERE/../refuses" 'touches find no surface' fettle-sample far.json --on "gantry:exec:fettle-gantry-virtual -q $PWD/far.json --stock $PWD/part.stl"
"$HERE/../refuses" 'for a SURFACE, not for a gantry' fettle-sample job.json --noise uniform:1 --on "gantry:exec:$driver"
"$HERE/../refuses" 'status 3' fettle-sample job.json --on 'gantry:exec:exit 3'
jq '.anomaly |= map(.[:2]) | .sampling |= map(.[:2])' job.json > flat.json
"$HERE/../refuses" 'how deep to search' fettle-sample flat.json --on "gantry:exec:fettle-gantry-virtual $PWD/flat.json --stock $PWD/part.stl"
