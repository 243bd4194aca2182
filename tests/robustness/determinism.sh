# Every output of every tool has the same bytes: with 1, 2 and 8 threads, a second time, to stdout as to a file, without a home folder, and
# where decimals have commas. With FETTLE_DRAWS=few (make test) without 2 threads. Clouds of four thousand points, so that there is work for more than one thread.
# shellcheck source=tests/robustness/tools.bash
. "$HERE/tools.bash"
inputs 0.5
if ! localedef -i de_DE -f UTF-8 ./de_DE.UTF-8 2>locale; then echo "no locale with decimal commas: $(tail -n 1 locale)"; fi
commas=(LOCPATH="$PWD" LC_ALL=de_DE.UTF-8 LC_NUMERIC=de_DE.UTF-8)
run() { # LABEL COMMAND…: all outputs into a folder, to be compared with those of one thread
    local status=0
    rm -rf again
    outputs again
    "${@:2}" "${command[@]}" "${named[@]}" -q >out 2>err <<<"$lines" || status=$?
    [ $status -le 1 ] || say "status $status: $(cat err)" "$1" "$name"
    diff -r once again >differences || say "$(head -n 1 differences)" "$1" "$name"
    tried=$((tried + 1))
}
few() { [ "${FETTLE_DRAWS:-all}" != all ]; }
for name in $names; do
    command_of "$name"
    tool=fettle-$name
    rm -rf once again
    outputs once
    "$tool" "${command[@]}" "${named[@]}" -q --threads 1 >printed 2>err <<<"$lines" || [ $? = 1 ] || say "$(cat err)" "$name"
    few || run '2 threads' "$tool" --threads 2
    run '8 threads' "$tool" --threads 8
    run 'no home, decimal commas' env -i PATH="$PATH" "${commas[@]}" "$tool" --threads 1
    [ ${#bulk[@]} = 1 ] || continue
    rm -rf again
    outputs again
    "$tool" "${command[@]}" "${named[@]:2}" -q >out 2>err <<<"$lines" || [ $? = 1 ] || say "$(cat err)" "$name"
    cmp -s out once/-o || say 'stdout is not what -o is' "$name"
done
few && all_tried 60 || all_tried 84
