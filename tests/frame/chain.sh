# A part that lies anyhow, and a job with the frame in which its anomaly faces up: the whole chain gives what it gives for the part that lies
# as the job has it. Each tool moves the part once, and says so in what it writes. Reference: the same chain without a frame.
part=$SAMPLES/parts/wang1.json
fettle-part "$part" -o lying.stl
fettle-part --without-anomaly "$part" -o desired.stl
cp "$SAMPLES/jobs/wang1.json" lying.json
fettle-place lying.stl --turn x,115,z,-40,y,10 --centre -o turned.stl --transform-out T.txt
fettle-place desired.stl --matrix T.txt -o turned-desired.stl
# A pose has a position and a unit quaternion, w first (Shepperd's method).
cat > pose.awk <<'AWK'
    { for (k = 1; k <= 4; ++k) m[NR, k] = $k }
    END { w = sqrt(1 + m[1, 1] + m[2, 2] + m[3, 3]) / 2
        printf "{\"position\": [%.17g, %.17g, %.17g], \"quaternion\": [%.17g, %.17g, %.17g, %.17g], \"theta_deg\": 0}\n",
            m[1, 4], m[2, 4], m[3, 4], w, (m[3, 2] - m[2, 3]) / (4 * w), (m[1, 3] - m[3, 1]) / (4 * w), (m[2, 1] - m[1, 2]) / (4 * w) }
AWK
jq --argjson frame "$(awk -f pose.awk T.txt)" '.frame = $frame' lying.json > turned.json

run() { # lying|turned
    local job=$1.json part=$1.stl desired=$2
    fettle-sample "$job" --on "$part" --seed 3 > "$1.samples.pcd"
    fettle-estimate "$job" "$1.samples.pcd" > "$1.points.pcd"
    fettle-fit "$job" "$1.points.pcd" | fettle-margin "$job" > "$1.surface.json"
    fettle-plan "$job" "$1.surface.json" > "$1.plan.json"
    fettle-grind "$1.plan.json" --stock "$part" --trace "$1.trace.pcd" > "$1.ground.pcd"
    fettle-compare "$1.ground.pcd" --to "$desired" --within "$job" --tolerance 0.05 --report "$1.report.json" > "$1.errors.pcd" || [ $? = 1 ]
    fettle-mesh "$1.surface.json" --step 0.1 --within "$job" --stl > "$1.mesh.stl"
}
run lying desired.stl
run turned turned-desired.stl
for kind in samples points errors ground; do fettle-diff --tol 2e-4 lying.$kind.pcd turned.$kind.pcd; done
numbers() { jq '.regions.inside | {count, mean, rms, min, max, p01, p50, p99, within}' "$1" > "$1.numbers"; }
for report in lying turned; do numbers $report.report.json; done
fettle-diff --tol 1e-3 lying.report.json.numbers turned.report.json.numbers
fettle-diff --tol 2e-4 lying.mesh.stl turned.mesh.stl
for kind in samples points trace ground errors; do
    grep -a -q '^# frame job$' turned.$kind.pcd
    if grep -a -q '^# frame' lying.$kind.pcd; then exit 1; fi
done
head -c 80 turned.mesh.stl | grep -a -q 'frame job'

# Into the job's frame and back; what is there already is not moved again.
fettle-place turned.stl --into turned.json --inverse back.txt -o there.stl
fettle-diff --tol 2e-4 there.stl lying.stl
fettle-place there.stl --into turned.json | fettle-diff --tol 1e-6 - there.stl
fettle-place there.stl --matrix back.txt | fettle-diff --tol 2e-4 - turned.stl
fettle-place turned.ground.pcd --matrix back.txt -o back.pcd
if grep -a -q '^# frame' back.pcd; then exit 1; fi
fettle-compare back.pcd --to turned-desired.stl --within turned.json --tolerance 0.05 --report back.json > back.errors.pcd || [ $? = 1 ]
numbers back.json
fettle-diff --tol 1e-3 turned.report.json.numbers back.json.numbers
# A scan, the crop of a job, its form and its picture are about the same places.
fettle-clean turned.ground.pcd --crop turned.json --report a.json -o a.pcd
fettle-clean back.pcd --crop turned.json --report b.json -o b.pcd
fettle-clean lying.ground.pcd --crop lying.json --report c.json -o c.pcd
jq -n --slurpfile a a.json --slurpfile b b.json --slurpfile c c.json '[$a[0].cropped, $b[0].cropped, $c[0].cropped]' -c
jq -e -n --slurpfile a a.json --slurpfile c c.json '$a[0].cropped == $c[0].cropped' > ok
form() { fettle-form flatness "$1" --within "$2" | jq '{count, minimum_zone, least_squares}'; }
form back.pcd turned.json > form.json
form lying.ground.pcd lying.json | fettle-diff --tol 1e-3 - form.json
fettle-render back.pcd --within turned.json -o a.png
fettle-render turned.ground.pcd --within turned.json -o b.png
# Two frames are not compared without the job that says where they are; so are bad poses refused.
refuse() { # TEXT JQ
    jq "$2" turned.json > bad.json
    if fettle-sample bad.json --on turned.stl 2> said > nothing; then exit 1; else [ $? = 2 ]; fi
    grep -q "$1" said || { cat said; exit 1; }
}
if fettle-compare turned.ground.pcd --to turned-desired.stl 2> said > nothing; then exit 1; else [ $? = 2 ]; fi
grep -q 'turned.ground.pcd: is in the frame of its job, turned-desired.stl in the part' said
refuse 'frame.quaternion: expected a unit quaternion' '.frame.quaternion = [0, 0, 0, 0]'
refuse 'frame.quaternion' '.frame.quaternion = [1, 0, 0]'
refuse 'frame.position: no casting reaches that far' '.frame.position = [1e30, 0, 0]'
refuse 'frame.pose' '.frame.pose = 1'
# Touches in the part's frame are moved before they are fitted.
fettle-place turned.samples.pcd --matrix back.txt -o part.samples.pcd
if grep -a -q '^# frame' part.samples.pcd; then exit 1; fi
fettle-fit turned.json turned.samples.pcd -q -o from-job.json
fettle-fit turned.json part.samples.pcd -q -o from-part.json
fettle-diff --tol 1e-3 from-job.json from-part.json
