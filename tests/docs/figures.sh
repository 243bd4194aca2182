# The table of the README, What it reaches: the draw of seed 1 on Wang's parts is none worse than the worst that it tells, and the words about
# budget.mk are the figures of docs/studies.md. Reference: pipelines/casting.mk, which makes the whole table as `casting.mk seeds`.
root=$(realpath "$HERE/../..")
build=$(realpath --relative-to="$root" "$BUILD")
unset MAKEFLAGS MFLAGS
run=$PWD/chain/1
make -s -C "$root" -f pipelines/casting.mk B="$build" CHAIN="$PWD/chain" "$run"/wang{1,2,3}/over.txt "$run/wang1/flatness.json" "$run/wang2/cylindricity.json" >&2
for part in wang1 wang2 wang3; do
    "$root/pipelines/seeds-table" "$PWD/chain" 1 $part >table
    # the worst, in brackets: of the README's row and of this draw
    worst() { tr -d ' ' <<<"$1" | grep -oE '\([0-9.]+\)' | tr -d '()'; }
    paste <(worst "$(grep -F "(\`$part\`)" "$root/README.md" | sed 's/(`.*`)//')") <(worst "$(cat table)") >numbers
    [ "$(wc -l <numbers)" = 6 ]
    awk '$2 > $1 { print "README: worst " $1 ", seed 1 " $2; exit 1 }' numbers
done
form() { jq '.least_squares * 25.4' "chain/1/$1.json"; }
readme_max() { grep -oE "$1 of [0-9.]+ \([0-9.]+\) mm" "$root/README.md" | grep -oE '\([0-9.]+' | tr -d '('; }
awk -v worst="$(readme_max flatness)" -v now="$(form wang1/flatness)" 'BEGIN { exit !(now <= worst + 0.0005) }'
awk -v worst="$(readme_max cylindricity)" -v now="$(form wang2/cylindricity)" 'BEGIN { exit !(now <= worst + 0.0005) }'
# The budget's rows: part 1 to 3 of docs/studies.md.
studies() { sed -nE "s/^\| $1 \| (.*) \|$/\1/p" "$root/docs/studies.md"; }
grep -qF "| mean, mm | $(studies 'all: mean, rms' | sed -E 's/, [0-9.]+//g') | 0.3 |" "$root/README.md"
grep -qF "| largest, mm | $(studies 'all: largest') | < 2.54 |" "$root/README.md"
grep -qF "| flatness, cylindricity, minimum zone, mm | $(studies 'flatness, cylindricity: worst draw' | sed 's/ | *$/ | –/') | 0.90, 0.93 |" "$root/README.md"
