# No tool and no option that names a file is missing in the table of tools.bash, and its commands do what it says: every output is written.
# What the other cases of this folder find holds for all tools only as long as this does. Reference: --help.
# shellcheck source=tests/robustness/tools.bash
. "$HERE/tools.bash"
inputs
reads='align:--transform-in arm:--srdf collide:--srdf find:--wheels gantry-robot:--srdf grind:--place margin:--scan merge:--poses mill:--design path:--no-room-for path:--part path:--room-for place:--matrix stock-linuxcnc:--after teach:--machine' # files that the commands do without, and only read
for file in "$HERE"/../../tools/fettle-*.cc; do
    name=$(basename "$file" .cc)
    [[ " ${names//$'\n'/ } gantry-linuxcnc step " == *" ${name#fettle-} "* ]] || say 'is not in tools.bash' "$name"
done
for name in $names; do
    command_of "$name"
    outputs "$name"
    "fettle-$name" "${command[@]}" "${named[@]}" -q >out 2>err <<<"$lines" || say "status $?: $(cat err)" "$name"
    for option in "${bulk[@]}" --report "${writes[@]}"; do [ -s "$name/$option" ] || say "$option is not written" "$name"; done
    [ "$name" = report ] || for option in $("fettle-$name" --help | sed -nE 's/^ +(-[a-z],)?(--[a-z-]+) FILE.*/\2/p'); do
        [[ " --output --report ${command[*]} ${writes[*]} " == *" $option "* || " $reads " == *" $name:$option "* ]] || say "$option is not in tools.bash" "$name"
    done
    tried=$((tried + 1))
done
all_tried 30
