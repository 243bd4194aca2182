# What is no steering, no machine or no command line: status 2, one line that names the place, nothing on stdout.
# shellcheck source=tests/fettle-grind/stock.bash
. "$HERE/../fettle-grind/stock.bash"
make_job 0
make_stock 0.01
machine="$SAMPLES/machines/full_scale.json"
printf '0 1 0\n' > fine
refuses() { "$HERE/../refuses" "$1" fettle-manual job.json --stock stock.stl --cell 0.4 "${@:2}"; }
refuses "line 2: '1 left' is none of" --machine "$machine" --steer <(printf '0 1 0\n1 left\n')
refuses "line 2: '1 2' is none of" --machine "$machine" --steer <(printf '0 1 0\n1 2\n')
refuses 'line 2: goes back in time, to 0.5' --machine "$machine" --steer <(printf '1 1 0\n0.5 end\n')
refuses "line 1: '0 nan 1' is none of" --machine "$machine" --steer <(printf '0 nan 1\n')
refuses 'none: cannot open' --machine "$machine" --steer none
refuses 'or --gantry must be given' --steer fine
refuses 'or --gantry must be given' --steer fine --machine "$machine" --gantry exec:true
refuses "'real' is not exec:COMMAND" --steer fine --gantry real
# A driver that is none, before anything moves.
printf '0 1 0\n' > fine
driven() { refuses "$1" --patience 1 --steer fine --gantry "exec:$2"; }
driven 'ended with status 127' 'no-such-program 2> nothing'
driven 'ended with status 3' 'exit 3'
driven 'makes no sense' 'echo hello; sleep 5'
driven 'speaks another protocol' 'echo 1 ok grbl 1.1; sleep 5'
refuses 'line 2: longer than 4096 bytes' --machine "$machine" --steer <(echo '0 1 0' && head -c 9000 /dev/zero | tr '\0' 1)
refuses 'cannot read: Is a directory' --machine "$machine" --steer .
# The last line of a file may lack its end.
fettle-manual job.json --stock stock.stl --cell 0.4 --machine "$machine" --steer <(printf '0 1 0\n0.5 1 0\n1 end\n') --report whole.json > ground.pcd
fettle-manual job.json --stock stock.stl --cell 0.4 --machine "$machine" --steer <(printf '0 1 0\n0.5 1 0\n1 end') --report cut.json > ground.pcd
cmp whole.json cut.json
