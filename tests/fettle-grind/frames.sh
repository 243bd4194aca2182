# Pictures of the stock during the run, at equal times where moves are short enough, and the last is that of the ground part. References: the
# trace's end, and the part's heights over the desired plane, z = 0.
echo '{"kind": "part", "units": {"length": "mm"}, "surface": {"type": "plane", "point": [0, 0, 0]}, "region": {"x": [-12, 12], "y": [-12, 12]},
    "step": 1, "anomalies": [{"type": "hill", "centre": [0, 0], "semi_axes": [4, 3], "height": 1}]}' | fettle-part -o stock.stl
cat >job.json <<'JOB'
{ "kind": "job", "units": {"length": "mm", "force": "N"}, "surface": {"type": "plane"}, "tolerance": 0.05, "safe_height": 20,
  "anomaly": [[-5, -5, 0], [5, -5, 0], [5, 5, 0], [-5, 5, 0]], "sampling": [[-10, -10, 0], [10, -10, 0], [10, 10, 0], [-10, 10, 0]] }
JOB
echo '{"kind": "surface", "units": {"length": "mm"}, "shape": {"type": "plane", "origin": [0, 0], "z0": 0, "slope": [0, 0]}}' | fettle-plan job.json >plan.json
fettle-grind plan.json --stock stock.stl --cell 0.5 --trace trace.pcd --frames 5 --frames-in pictures --report grind.json -o ground.pcd || [ $? = 1 ]
jq -e '.kind == "frames" and (.frames | length) == 3 and ([.frames[].t] == ([.frames[].t] | sort)) and .frames[2].picture == "003.png"' pictures/frames.json >/dev/null
jq -es '(.[0].frames[2].t - .[1].machine_time | fabs) < 1e-6' pictures/frames.json grind.json >/dev/null
for n in 1 2 3; do head -c 4 pictures/00$n.png | tail -c 3 | grep -qx PNG; done
[ "$(find pictures -name '*.png' | wc -l)" = 3 ]
! cmp -s pictures/001.png pictures/003.png || exit 1
fettle-report --plan plan.json --grinding grind.json --trace trace.pcd --frames pictures/frames.json -o page.html
[ "$(grep -o 'data-t="' page.html | wc -l)" = 3 ]
grep -q 'class="time-axis"' page.html
# Without --frames nothing is written.
fettle-grind plan.json --stock stock.stl --cell 0.5 -o again.pcd || [ $? = 1 ]
cmp ground.pcd again.pcd
[ ! -e frames ]
echo '{"kind": "frames", "shown": "", "frames": [{"t": 1, "picture": "../page.html"}]}' >pictures/bad.json
"$HERE/../refuses" 'is not a file beside this one: ../page.html' fettle-report --plan plan.json --frames pictures/bad.json
