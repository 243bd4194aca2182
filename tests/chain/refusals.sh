# What fails at the end still leaves nothing on stdout and one line on stderr: a report that cannot be written, a
# warning before the refusal. Two outputs never go to one place. Reference: the rules of every tool.
refuses=$HERE/../refuses
for report in missing/report.json /dev/full; do
    "$refuses" "$report: cannot write" fettle-part "$SAMPLES/parts/wang1.json" --report "$report"
    "$refuses" "$report: cannot write" fettle-diff "$SAMPLES/jobs/wang1.json" "$SAMPLES/jobs/wang1.json" --report "$report"
done
printf 'nan nan nan\n1 2 3\n' >one.xyz
"$refuses" 'one.xyz: flatness: needs at least 3 points, got 1' fettle-form flatness one.xyz
part=$SAMPLES/parts/wang1.json
"$refuses" './out: named for two outputs' fettle-part "$part" -o out --report ./out
"$refuses" 'stdout: named for two outputs' fettle-part "$part" --report -
fettle-part "$part" -o out --report - | jq -e 'type == "object"' >report
# Names may hold what moves a terminal's cursor; the message does not.
status=0
fettle-part $'no\e[2J\nwhere' 2>err || status=$?
[ $status -eq 2 ]
[ "$(wc -l <err)" -eq 1 ]
if grep -q $'\e' err; then exit 1; fi
