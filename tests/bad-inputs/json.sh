# JSON that is none, or not what it should be, in every place where a tool reads it; jobs that cannot be, for every tool that takes one:
# refused, within the bounds of probe.bash.
# shellcheck source=tests/bad-inputs/probe.bash
. "$HERE/probe.bash"
good
jq -n '{kind: "patches", units: {length: "mm"}, patches: [{degree: [1, 1], knots_u: [0, 0, 1, 1], knots_v: [0, 0, 1, 1],
    control: [[[0, 0, 5], [0, 40, 5]], [[40, 0, 5], [40, 40, 5]]]}]}' >patches.json
cp "$SAMPLES/parts/hill.json" part.json
fettle-compare good.pcd --to plate.stl --report comparison.json -q -o errors.pcd
fettle-align good.pcd --to plate.stl --near --report alignment.json -q -o aligned.pcd || test $? = 1
fettle-form flatness good.pcd >form.json
fettle-grind plan.json --stock good.pcd --cell 0.5 --report grinding.json -q -o ground.pcd

places() { # KIND R|S|G FILE: of a model
    case $1 in
    job)
        try "$2" "$3" fettle-clean good.pcd --crop "$3"
        try "$2" "$3" fettle-sample "$3" --on good.pcd
        try "$2" "$3" fettle-estimate "$3" samples.pcd
        try "$2" "$3" fettle-fit "$3" samples.pcd
        try "$2" "$3" fettle-margin "$3" fit.json
        try "$2" "$3" fettle-plan "$3" surface.json
        try "$2" "$3" fettle-compare good.pcd --to plate.stl --within "$3"
        try "$2" "$3" fettle-mesh surface.json --step 4 --within "$3"
        try "$2" "$3" fettle-form flatness good.pcd --within "$3"
        try "$2" "$3" fettle-render good.pcd --within "$3"
        try "$2" "$3" fettle-report --job "$3"
        try "$2" "$3" fettle-gantry-virtual "$3" --stock good.pcd --cell 2
        try "$2" "$3" fettle-manual "$3" --stock good.pcd --cell 2 --machine machine.json --steer -
        try "$2" "$3" fettle-stock-linuxcnc "$3" --stock good.pcd --cell 2
        ;;
    surface)
        try "$2" "$3" fettle-mesh "$3" --at good.pcd
        try "$2" "$3" fettle-plan job.json "$3"
        try "$2" "$3" fettle-report --surface "$3"
        ;;
    fit) try "$2" "$3" fettle-margin job.json "$3" ;;
    plan)
        try "$2" "$3" fettle-grind "$3" --stock good.pcd --cell 0.5
        try "$2" "$3" fettle-gantry-virtual "$3" --stock good.pcd --cell 2
        try "$2" "$3" fettle-report --plan "$3"
        try "$2" "$3" fettle-stock-linuxcnc "$3" --stock good.pcd --cell 2
        ;;
    machine)
        try "$2" "$3" fettle-grind plan.json --stock good.pcd --cell 0.5 --gantry virtual:dynamic --machine "$3"
        try "$2" "$3" fettle-gantry-virtual plan.json --stock good.pcd --cell 2 --machine "$3"
        try "$2" "$3" fettle-manual job.json --stock good.pcd --cell 2 --machine "$3" --steer -
        [ "$2" != R ] || try R "$3" fettle-teach job.json --gantry virtual:dynamic --stock plate.stl --machine "$3" --steer - # without points there is no job
        ;;
    wheel)
        try "$2" "$3" fettle-contact good.pcd --wheel "$3" --at 15,15,5,1,0,0,0 --force 5
        try "$2" "$3" fettle-belt good.pcd --path good.pcd --wheel "$3" --force 5
        try "$2" "$3" fettle-feed good.pcd --on good.pcd --wheel "$3" --force 5 --cells 8 --rounds 1
        ;;
    robot)
        try "$2" "$3" fettle-arm "$3" --inverse good.pcd
        try "$2" "$3" fettle-collide "$3" good.pcd
        ;;
    part) try "$2" "$3" fettle-part "$3" ;;
    patches) try "$2" "$3" fettle-surfel "$3" --stock plate.stl --spacing 4 ;;
    comparison | grinding | form | alignment) try "$2" "$3" fettle-report "--$1" "$3" ;;
    esac
}
kinds='job surface fit plan machine wheel robot part patches comparison grinding form alignment'
brackets=$(head -c 100000 /dev/zero | tr '\0' '[')
for kind in $kinds; do
    one=$(jq -c . $kind.json)
    places $kind G $kind.json
    bad() { cat >"$1"; [ "$1" = empty.json ] || [ -s "$1" ] || say 'empty' "$1"; places "$kind" R "$1"; places_of_diff "$1"; }
    places_of_diff() { try R "$1" fettle-diff "$kind.json" "$1"; }
    bad empty.json </dev/null
    bad truncated.json <<<"${one:0:${#one}/2}"
    bad duplicate.json <<<"{\"units\": 1, ${one:1}"
    bad comma.json <<<"${one%\}},}"
    bad nan.json < <(sed 's/\(:\|\[\)-\?[0-9][0-9.eE+-]*/\1NaN/' <<<"$one")
    bad beyond.json < <(sed 's/\(:\|\[\)-\?[0-9][0-9.eE+-]*/\11e999/' <<<"$one")
    bad nested.json <<<"{\"kind\": \"$kind\", \"units\": $brackets"
    bad utf16.json < <(iconv -t UTF-16 <<<"$one")
    places_of_diff() { :; } # any JSON will do for it
    bad type.json < <(jq '.units = 7' <<<"$one")
    bad kind.json < <(jq '.kind = "zebra"' <<<"$one")
    bad no-units.json < <(jq 'del(.units)' <<<"$one")
    bad array.json <<<"[$one]"
    # reports may say more than a page shows
    case $kind in comparison | grinding | form | alignment) ;; *) bad unknown.json < <(jq '.zebra = 1' <<<"$one") ;; esac
    { printf '\357\273\277'; jq . $kind.json | sed 's/$/\r/'; } >bom.json
    places $kind G bom.json
    try G bom.json fettle-diff $kind.json bom.json
done

job() { # CHANGE…
    local change
    for change in "$@"; do
        jq "$change" job.json >changed.json
        places job R changed.json
    done
}
job '.anomaly |= .[:2]' '.anomaly = [[10, 10], [20, 20], [20, 10], [10, 20]]' '.anomaly = [[10, 10], [15, 15], [20, 20]]' '.anomaly[0] = [-90, 10]' \
    '.anomaly = .sampling' '.force.min = 70' '.force.down = 70' '.force.preload = 60' '.force.stiffness = 0' '.feed.rate = -1' '.feed.step_over = 6' '.wheel.radius = 0'
# a million objects in an array, and one of as many members: refused, or compared, in a time that grows as they do
{ printf '{"kind": "job", "units": ['; printf '{},%.0s' {1..1000000}; echo '0]}'; } >objects.json
try R objects.json fettle-fit objects.json samples.pcd
try G objects.json fettle-diff job.json objects.json
{ printf '{"kind": "job"'; seq 100000 | sed 's/.*/, "&": 0/'; echo '}'; } >members.json
try R members.json fettle-fit members.json samples.pcd
try R members.json fettle-diff job.json members.json
jq '.anomaly |= reverse | .sampling |= reverse' job.json >clockwise.json
places job G clockwise.json
all_tried 600
