# What fails at the end still leaves nothing on stdout and one line on stderr: a report that cannot be written, a
# warning before the refusal. Reference: the rules of every tool.
refuses=$HERE/../refuses
for report in missing/report.json /dev/full; do
    "$refuses" "$report: cannot write" fettle-part "$SAMPLES/parts/wang1.json" --report "$report"
    "$refuses" "$report: cannot write" fettle-diff "$SAMPLES/jobs/wang1.json" "$SAMPLES/jobs/wang1.json" --report "$report"
done
printf 'nan nan nan\n1 2 3\n' >one.xyz
"$refuses" 'one.xyz: flatness: needs at least 3 points, got 1' fettle-form flatness one.xyz
