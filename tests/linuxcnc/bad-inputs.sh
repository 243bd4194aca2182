# What is no job, no configuration, or no LinuxCNC that runs: status 2, one line.
# shellcheck source=tests/linuxcnc/machine.bash
. "$HERE/machine.bash"
refuses=$HERE/../refuses
cp "$SAMPLES/jobs/wang3.json" job.json
cp "$machine/grind.ini" "$machine/grind.nml" .
echo '[EMC]' > no.ini
: > empty
"$refuses" '--ini is required' fettle-gantry-linuxcnc job.json
"$refuses" 'empty: empty, expected JSON' fettle-gantry-linuxcnc empty --ini grind.ini
"$refuses" 'nowhere.ini: cannot be read' fettle-gantry-linuxcnc job.json --ini nowhere.ini
"$refuses" 'no.ini: [EMC]NML_FILE is missing' fettle-gantry-linuxcnc job.json --ini no.ini
"$refuses" 'LinuxCNC does not answer by grind.nml' fettle-gantry-linuxcnc job.json --ini grind.ini
"$refuses" 'ended with status 2' fettle-sample job.json --on 'gantry:exec:fettle-gantry-linuxcnc job.json --ini nowhere.ini 2> message'

# LinuxCNC that cannot start: a stock that is none. What is left of the attempt is a log.
if "$machine/start" broken empty 2> message; then exit 1; fi
grep -q 'LinuxCNC did not start' message
grep -q 'fettle_head: run/stock: is no stock of a simulated head' broken/log
if pgrep -f "$PWD/broken" > left; then cat left; exit 1; fi
