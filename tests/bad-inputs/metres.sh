# A part in metres is taken for millimetres by nobody without a word: every tool that reads a part without a job warns of a size that is hardly meant.
# Reference: a plate of 40 mm, of which a file in metres has 0.04.
# shellcheck source=tests/robustness/tools.bash
. "$HERE/../robustness/tools.bash"
inputs
awk 'BEGIN { for (i = 0; i < 40; i++) for (j = 0; j < 40; j++) print i, j, 5 + sin(i / 4) * cos(j / 5), 0, 0, 1 }' | pcd 'x y z normal_x normal_y normal_z' >mm.pcd
fettle-reconstruct mm.pcd -q -o mm.stl
fettle-place mm.stl --units m -q -o metres.stl
awk '/^[0-9]/ { for (k = 1; k <= 3; k++) $k /= 1000 } { print }' mm.pcd >metres.pcd
while read -r -a words; do
    status=0
    fettle-"${words[@]}" >out 2>err </dev/null || status=$?
    if ! grep -qE 'metres\.(stl|pcd): .*is its unit right\?' err; then
        echo "no word from fettle-${words[*]}, status $status"
        cat err
        exit 1
    fi
done <<'COMMANDS'
align metres.stl --to metres.stl --near -o o.pcd
clean metres.pcd -o o.pcd
collide robot.json tips.pcd --workpiece metres.stl -o o.pcd
compare metres.pcd --to metres.stl -o o.pcd
find metres.stl -o o.pcd
finish metres.stl --cutter ball:6 --step-over 1 -o o.nc
form flatness metres.pcd -o o.json
merge metres.pcd metres.stl -o o.pcd
mill path.nc --stock metres.stl --cutter ball:6 --step 0.0005 -o o.stl
place metres.stl --turn x,5 -o o.stl
reconstruct metres.pcd -o o.stl
render metres.stl -o o.png
sample job.json --on metres.stl -o o.pcd
surfel metres.stl --stock metres.stl --spacing 0.004 -o o.pcd
verify metres.stl --design metres.stl --step 0.004 -o o.pcd
view metres.stl -o o.html
COMMANDS
