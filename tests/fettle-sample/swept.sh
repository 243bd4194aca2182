# A straight swept surface with rulings along X: three touches on a line of the whole length of the boundary, four
# uniform ones over the anomaly's width where a line across is free. Reference: Wang 2007, 4.4.4, 2, case (a), by hand:
# of the free strips y < 10 and y > 22 the line a tenth into the upper one is nearest to the anomaly's middle, y = 16.
cat > job.json <<'JOB'
{"kind": "job", "units": {"length": "mm"}, "surface": {"type": "swept", "direction_deg": 0},
 "anomaly": [[10, 10], [20, 10], [20, 22], [10, 22]], "sampling": [[0, 0], [50, 0], [50, 30], [0, 30]]}
JOB
fettle-sample job.json --plan-only --ascii | grep '^DATA' -A 7 | tail -n 7 | awk '{ print $4, $5, $1, $2 }' | sort -n
