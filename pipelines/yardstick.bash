# shellcheck shell=bash
# Processor time beside a yardstick in the same run: other work on the machine lengthens both, and another machine is as fast for both.

# processor_ms COMMAND...: what it takes, user and system, ms; with of_system=0 the user's alone; fails if it fails
processor_ms() {
    local TIMEFORMAT='%3U %3S'
    { time "$@" >/dev/null 2>&1; } 2>&1 | awk -v share="${of_system:-1}" '{ print 1000 * ($1 + share * $2) }'
}

# least_of N COMMAND...: the least of N
least_of() {
    local n=$1 run
    shift
    for ((run = 0; run < n; run++)); do processor_ms "$@"; done | sort -g | head -n 1
}

# The figures are milliseconds of a machine, quiet, on which this took 90.
yardstick_there=90
yardstick() { seq 300000 | gzip -6; }
yardstick_here=$(least_of 9 yardstick)
# there MS: what they would have been on that machine
there() { awk "BEGIN { print $1 * $yardstick_there / $yardstick_here }"; }
