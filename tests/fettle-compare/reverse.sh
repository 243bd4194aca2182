# Both ways: the test lacks a corner of the plate, which only the other direction sees as far from it. Reference: heights
# by hand; material left is + both ways.
printf 'v 0 0 0\nv 10 0 0\nv 10 10 0\nv 0 10 0\nf 1 2 3 4\n' >plate.obj
printf 'v 0 0 0.5\nv 10 0 0.5\nv 10 5 0.5\nv 0 5 0.5\nf 1 2 3 4\n' >half.obj
fettle-compare half.obj --to plate.obj --reverse back.csv --format csv --report report.json --csv statistics.csv
cat back.csv
cut -d , -f 1-4,8-9 statistics.csv
jq -c '[.count, .mean, .reverse.count, .reverse.undefined, .reverse.mean]' report.json
# The verdict is about both.
printf 'v 0 0 0\nv 10 0 0\nv 10 10 0.25\nv 0 10 0.25\nv 0 20 9\nv 10 20 9\nf 1 2 3 4\nf 4 3 6 5\n' >bent.obj
printf 'v 0 0 0\nv 10 0 0\nv 10 10 0\nv 0 10 0\nv 10 20 0\nv 0 20 0\nf 1 2 3 4\nf 4 3 5 6\n' >long.obj
fettle-compare plate.obj --to bent.obj --tolerance 0.3 -o /dev/null
status=0
fettle-compare long.obj --to bent.obj --tolerance 0.3 --reverse back.pcd -o /dev/null || status=$?
[ $status -eq 1 ]
