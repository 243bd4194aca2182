# Points that determine no surface, or are none; jobs that are none; command lines.
source "$HERE/points.bash"
refuses=$HERE/../refuses
job freeform >job.json
job plane >plane.json
heights 1 20 1 | touches >good.pcd
: >empty
"$refuses" 'empty' fettle-fit job.json empty
"$refuses" 'stdin' fettle-fit job.json </dev/null
"$refuses" 'job.json' fettle-fit job.json job.json
"$refuses" "good.pcd: line 1, column 1: expected JSON, got '# " fettle-fit good.pcd good.pcd
# the two arguments in the wrong order, for each kind of points; points alone
order='(the arguments are JOB [POINTS])'
echo '1 2 3' >points.xyz
for points in good.pcd points.xyz; do
    "$refuses" "$points: line 1, column 1: expected JSON, got" fettle-fit $points job.json
    "$refuses" "$order" fettle-fit $points job.json
    "$refuses" "$order" fettle-fit $points <job.json
done
"$refuses" "job.json: JSON, expected points $order" fettle-fit job.json job.json
"$refuses" 'nowhere.pcd' fettle-fit job.json nowhere.pcd
"$refuses" '--method' fettle-fit job.json good.pcd --method spheer
"$refuses" "did you mean 'sphere'?" fettle-fit job.json good.pcd --method spheer
"$refuses" '/dev/full' fettle-fit job.json good.pcd -o /dev/full
# too few
heights 1 3 1 | touches >three.pcd
"$refuses" 'three.pcd: a sphere fit needs at least 4 touches, got 3 of 3 points that it may use' \
    fettle-fit job.json three.pcd --method sphere
"$refuses" 'three.pcd: a cylinder fit needs at least 5 touches' fettle-fit job.json three.pcd --method cylinder
"$refuses" 'three.pcd: a freeform fit needs at least 6 touches' fettle-fit job.json three.pcd
echo '1 2 3' | touches >one.pcd
"$refuses" 'one.pcd: a plane fit needs at least 3 touches, got 1 of 1' fettle-fit plane.json one.pcd
for i in 1 2 3 4 5 6 7 8; do echo "$i nan $i"; done | touches >nan.pcd
"$refuses" 'nan.pcd: a freeform fit needs at least 6 touches, got 0 of 8' fettle-fit job.json nan.pcd
# on a line, all the same, on a circle
for i in 1 2 3 4 5 6 7 8; do echo "$i $i $i"; done | touches >line.pcd
for i in 1 2 3 4 5 6 7 8; do echo 1 2 3; done | touches >same.pcd
for points in line same; do
    "$refuses" "$points.pcd: touches lie on a line: across it they spread by only" fettle-fit plane.json $points.pcd
    for method in bspline bspline-wang sphere cylinder swept auto; do
        "$refuses" "$points.pcd: touches lie on one line in x and y" fettle-fit job.json $points.pcd --method $method
    done
done
printf '1 0 0\n0 1 0\n-1 0 0\n0 -1 0\n0.6 0.8 0\n0.8 -0.6 0\n' | touches >circle.pcd
"$refuses" 'circle.pcd: touches do not determine a sphere' fettle-fit job.json circle.pcd --method sphere
# roles that are none, units that disagree
heights 1 20 1 | sed 's/$/ 7/' | pcd x y z role >role.pcd
"$refuses" 'role.pcd: point 0: 7 is not a role (0 to 5)' fettle-fit job.json role.pcd
sed '/^COUNT/s/1$/3/' role.pcd >roles.pcd
"$refuses" "roles.pcd: field 'role': COUNT 3, expected 1" fettle-fit job.json roles.pcd
# a curve's number beyond all integers is none
for curve in nan 1e30; do heights 1 20 1 | sed "s/\$/ 1 $curve/" | pcd x y z role curve >$curve.pcd; done
fettle-diff <(fettle-fit job.json nan.pcd) <(fettle-fit job.json 1e30.pcd)
sed 's,# units in,# units mm,' good.pcd >mm.pcd
"$refuses" 'mm.pcd' fettle-fit job.json mm.pcd
# a grid too fine; a boundary of which no height is known; a scan, which shows it itself
"$refuses" 'good.pcd: the spacing of ' fettle-fit job.json good.pcd --method griddata --spacing 1e-6
"$refuses" 'good.pcd: no point of role 0, and no boundary point of the job has a z' fettle-fit job.json good.pcd --use-boundary
printf '0 0 0\n1 0 0\n0 1 0\n0 0 0\n1 0 0\n' | touches >thrice.pcd
"$refuses" 'thrice.pcd: the B-spline takes from 4 to ' fettle-fit job.json thrice.pcd --method bspline-wang
heights 1 3000 1 | pcd x y z >scan.pcd
fettle-fit job.json scan.pcd --use-boundary -o scan.json 2>said
grep -q 'use-boundary: a scan shows the metal at the boundary itself' said
