# What are no points, or points that make no job: status 2, one line, nothing on stdout.
job=$SAMPLES/jobs/wang1.json
: > empty
printf '1,2\n' > two.txt
printf '1,2,3\n1,2,x\n' > word.txt
printf 'Point index picked: 1 (real: 1) - [1, 2\n' > cut.txt
printf '0,0,1\n1,1,1\n1,0,1\n0,1,1\n' > crossed.txt
printf '0,0,1\n1,0,1\n1,1,1\n0,1,1\n' > good.txt
refuses() { "$HERE/../refuses" "$1" fettle-teach "$job" "${@:2}"; }
refuses 'empty: empty, expected picked points' --anomaly empty
refuses "two.txt: line 1: '1,2' is not a point" --anomaly two.txt
refuses "word.txt: line 2: '1,2,x' is not a point" --anomaly word.txt
refuses 'cut.txt: line 1' --anomaly cut.txt
refuses 'the job that was taught: anomaly' --anomaly crossed.txt
refuses 'the job that was taught: sampling' --anomaly good.txt --surface freeform --sampling good.txt
refuses '--direction: goes with a swept surface alone' --anomaly good.txt --direction 3
refuses 'none.txt: cannot open' --anomaly none.txt
refuses '--anomaly: or --gantry must be given'
