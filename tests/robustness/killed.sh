# Killed at any moment, by KILL, TERM or INT, a tool leaves its outputs as they were or all of them whole: never a part of a file, and no
# other file, but after KILL perhaps a hidden temporary file, which is harmless. Exceptions are what is written ahead, line by line: traces of
# machines, --watch; and the journal, which is there to go on from (tests/fettle-belt/journal.sh, tests/fettle-grind/resume.sh); so is the folder of a session (tests/fettle-station/killed.sh).
# shellcheck source=tests/robustness/tools.bash
. "$HERE/tools.bash"
inputs
mkdir place
killed=0
moments=('3 KILL' '6 TERM' '8 INT' '9 KILL')
min_killed=20
# With FETTLE_DRAWS=few (make test) two of the moments.
[ "${FETTLE_DRAWS:-all}" = all ] || { moments=('6 TERM' '9 KILL') && min_killed=10; }
for name in $names; do
    command_of "$name"
    outputs once
    begun=$(date +%s%N)
    "fettle-$name" "${command[@]}" "${named[@]}" -q >out 2>err <<<"$lines" || say "$(cat err)" "$name"
    took=$((($(date +%s%N) - begun) / 1000)) # us
    outputs place
    for moment in "${moments[@]}"; do
        read -r tenths signal <<<"$moment"
        rm -rf place/* place/.[!.]*
        for option in "${bulk[@]}" --report "${writes[@]}"; do [[ " --journal --session --frames-in " == *" $option "* ]] || echo 'what was there' >"place/$option"; done
        status=0
        after=$(awk -v t=$((took * tenths / 10)) 'BEGIN { printf "%.6f", t / 1e6 }')
        { timeout -s $signal "$after" "fettle-$name" "${command[@]}" "${named[@]}" -q >out 2>err <<<"$lines"; } 2>said || status=$?
        tried=$((tried + 1))
        [ $status = 0 ] || killed=$((killed + 1))
        [ ! -s err ] || say "said $(cat err)" "$name $moment"
        for option in "${bulk[@]}" --report "${writes[@]}"; do
            case "$name $option" in 'belt --watch' | 'belt --journal' | 'grind --trace' | 'manual --trace' | 'station --session') continue ;; esac
            if [ "$option" = --frames-in ]; then
                for picture in place/--frames-in/*; do
                    [ ! -e "$picture" ] || cmp -s "$picture" "once/--frames-in/${picture##*/}" || say "$picture is half-written" "$name $moment"
                done
                continue
            fi
            # Asked to end, a session stops its machine and reports how far it came.
            [ "$name $option" != 'station --report' ] || { jq -e '.kind == "station" and .stage != null' "place/$option" >/dev/null 2>&1 && continue; }
            cmp -s "place/$option" "once/$option" || grep -qx 'what was there' "place/$option" || say "$option is half-written" "$name $moment"
        done
        hidden=$(find place -name '.*' ! -name place)
        [ -z "$hidden" ] || [ $signal = KILL ] || say "left $hidden" "$name $moment"
    done
    # Temporary files left by a killed run with this number are harmless.
    [ ${#bulk[@]} = 1 ] || continue
    rm -rf place/* place/.[!.]*
    elsewhere -o place/-o
    bash -c ': >place/.fettle-$$--o; exec "$@"' - "fettle-$name" "${command[@]}" "${named[@]}" -q >out 2>err || say "$(cat err)" "$name"
    cmp -s place/-o once/-o && [ -z "$(find place -name '.*--o')" ] || say 'is hindered by what was left' "$name"
done
echo "$killed were killed before their end"
[ $killed -ge $min_killed ]
all_tried $((min_killed * 11 / 2))
