# Outputs in places where they cannot be, for every output of every tool: a folder that is missing, one that may not be written to, a name
# that is a folder's, and the name of an input, which would be lost. Refused before any work, in one line that names the place, and the
# inputs are as they were. Only what is made of an input may take its place: the bulk output that of the bulk input, a corrected path that of
# the path.
# shellcheck source=tests/robustness/tools.bash
. "$HERE/tools.bash"
inputs
mkdir folder locked
chmod 555 locked
nobody=() # root may write anywhere
if [ "$(id -u)" = 0 ]; then
    nobody=(setpriv --reuid=65534 --regid=65534 --clear-groups)
    chmod 755 . ..
    "${nobody[@]}" "$(command -v fettle-diff)" --version >version 2>&1 || { echo 'nothing is said about folders that may not be written to: only root can run the tools here'; nobody=(false); }
fi
refused() { # OPTION PLACE [AS…]
    local status=0
    elsewhere "$1" "$2"
    "${@:3}" "fettle-$name" "${command[@]}" "${named[@]}" >out 2>err <<<"$lines" || status=$?
    tried=$((tried + 1))
    is_refusal $status "$2" || say "status $status: $(head -c 200 err)" "$name $1 $2"
}
for name in $names; do
    command_of "$name"
    for option in "${bulk[@]}" --report "${writes[@]}"; do
        refused "$option" missing/out
        [ "$option" = --session ] || [ "$option" = --frames-in ] || refused "$option" folder # these are kept in a folder
        [ "${nobody[*]}" = false ] || refused "$option" locked/out "${nobody[@]}"
    done
    bulk_input=
    if "fettle-$name" --help | grep -q 'stdin if it is - or missing'; then bulk_input=${command[-1]}; fi
    for input in "${command[@]}"; do
        [ -f "$input" ] || continue
        cp "$input" kept
        for option in "${bulk[@]}" --report "${writes[@]}"; do
            case "$option $input" in "-o $bulk_input" | '--corrected path.nc') continue ;; esac
            refused "$option" "$input"
            cmp -s kept "$input" || say 'is not as it was' "$name $option $input"
        done
    done
    [ -n "$bulk_input" ] || continue
    outputs once
    fettle-"$name" "${command[@]}" "${named[@]}" -q >out 2>err || say "$(cat err)" "$name"
    cp "$bulk_input" itself
    rm -f once/--journal
    fettle-"$name" "${command[@]:0:${#command[@]}-1}" itself "${named[@]:2}" -o itself -q >out 2>err || say "$(cat err)" "$name" &&
        cmp -s itself once/-o || say 'in its own place it is another' "$name"
done
[ -z "$(ls -A folder locked | grep -v :)" ] || say 'left' "$(ls -A folder locked)"
all_tried 350
