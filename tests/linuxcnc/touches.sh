# 25 touches by G38.2 on Wang's part 3, fast and then slowly: where they are on the part itself, within 0.0005 in.
# shellcheck source=tests/linuxcnc/machine.bash
. "$HERE/machine.bash"
fettle-part "$SAMPLES/parts/wang3.json" > part.stl
jq '.safe_height = 1.2' "$SAMPLES/jobs/wang3.json" > job.json
fettle-stock-linuxcnc job.json --stock part.stl --cell 0.004 > before
start before
fettle-sample job.json --strategy wang --lines 4 --on "gantry:exec:$(driver job.json)" --report report.json > machine.pcd
stop
jq -e '.touches >= 25' report.json
fettle-sample job.json --strategy wang --lines 4 --on part.stl > scan.pcd
fettle-diff --tol 0.0005 machine.pcd scan.pcd
