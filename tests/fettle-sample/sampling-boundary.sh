# The points of the sampling boundary as touches: on no line, of role 2, where the job has them. Reference: the job itself.
job=$SAMPLES/jobs/wang3.json
fettle-part "$SAMPLES/parts/wang3.json" --without-anomaly >part.stl
fettle-sample "$job" --on part.stl --sampling-boundary --ascii --report report.json >samples.pcd
jq -e '.touches == 20 and .lines == 4' report.json
points() { grep '^DATA' -A 99 samples.pcd | awk '$4 == -1 && $5 == 2 { printf "%.2f %.2f\n", $1, $2 }' | sort; }
jq -r '.sampling[] | "\(.[0] * 100 | round / 100) \(.[1] * 100 | round / 100)"' "$job" | awk '{ printf "%.2f %.2f\n", $1, $2 }' | sort | cmp - <(points)
# estimated points are those of the lines alone
fettle-sample "$job" --on part.stl | fettle-estimate "$job" --ascii | tail -n 4 | cut -d ' ' -f 1-3 >lines
fettle-estimate "$job" samples.pcd --ascii | tail -n 4 | cut -d ' ' -f 1-3 | cmp lines -
# their places only, with the heights that the job has
fettle-sample "$job" --sampling-boundary --plan-only --ascii | grep '^DATA' -A 99 | awk '$5 == 2 && $4 == -1 && $3 > 0.4 { ++n } END { exit n != 4 }'
"$HERE/../refuses" '--sampling-boundary is for --strategy wang' fettle-sample "$job" --on part.stl --sampling-boundary --strategy adaptive
jq 'del(.sampling) | .surface.type = "plane"' "$job" >plane.json
"$HERE/../refuses" 'plane.json: sampling: there are no points to touch' fettle-sample plane.json --sampling-boundary
