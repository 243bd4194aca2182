# All that makes a registration doubtful is said on stderr and in the report, and with --sure it is exit 1.
# Reference: a square plate fits in eight ways; half a kilometre away nothing fits; a plane leaves motions open.
aligned() { # STATUS ARGUMENT…
    local status=0 expected=$1
    shift
    fettle-align "$@" --report r.json -o out.pcd 2>err || status=$?
    [ $status -eq "$expected" ] || { echo "status $status: $*"; cat err; exit 1; }
}
awk 'BEGIN { for (i = 0; i <= 40; i++) for (j = 0; j <= 40; j++) print i, j, (i < 9 && j < 9 || i > 31 && j > 31 || i < 9 && j > 31 || i > 31 && j < 9 ? 4 : 0) }' >square.xyz
aligned 0 square.xyz --to square.xyz
grep -q 'another place fits nearly as well' err
jq -e '.doubt | contains("another place fits nearly as well")' r.json >/dev/null
aligned 1 square.xyz --to square.xyz --sure
awk 'BEGIN { for (i = 0; i < 40; i++) for (j = 0; j < 30; j++) print i, j, 4 * sin(i / 6) + 3 * cos(j / 5 + 1) + i * j / 100 }' >waves.xyz
aligned 0 waves.xyz --to waves.xyz --sure
[ ! -s err ]
jq -e '.converged and .doubt == ""' r.json >/dev/null
# far away the distances across the surface vanish, too
fettle-part "$SAMPLES/parts/hammer.json" -o part.stl
printf '1 0 0 500000\n0 1 0 0\n0 0 1 0\n0 0 0 1\n' >far.txt
aligned 1 part.stl --to part.stl --transform-in far.txt
grep -q 'warning: part.stl: the steps did not converge on a place where the scan lies on the reference' err
jq -e '(.converged | not) and (.doubt | startswith("the steps did not converge"))' r.json >/dev/null
# a report page says it, too
fettle-align square.xyz --to square.xyz --report r.json -q -o out.pcd
fettle-report --alignment r.json -o page.html -q && grep -q 'another place fits nearly as well' page.html
# and shows that place; from its matrix the next alignment goes there, and the turns between the two are those of a square
grep -q 'Another place fits nearly as well: turned by' page.html
jq -r '.next.transform[] | map(tostring) | join(" ")' r.json > next.txt
aligned 0 square.xyz --to square.xyz --start next.txt
awk 'NR == FNR { for (k = 1; k <= 4; ++k) m[NR, k] = $k; next } { for (k = 1; k <= 4; ++k) if (($k - m[FNR, k])^2 > 1e-6) exit 1 }' next.txt <(jq -r '.transform[] | map(tostring) | join(" ")' r.json)
# one of the two in metres
awk '{ print $1 / 1000, $2 / 1000, $3 / 1000 }' waves.xyz >metres.xyz
aligned 0 metres.xyz --to waves.xyz --near --iterations 0
grep -q 'metres.xyz: the part, 0.039 x 0.029 x 0.[0-9]* mm, is under 5 mm long: is its unit right?' err
grep -q 'metres.xyz: is 0.001 times as long as waves.xyz: are the units of both right?' err
aligned 0 metres.xyz --file-units m --to waves.xyz --near
[ ! -s err ]
# A distance longer than the scan is no limit: the same place as without it, and no longer a search.
fettle-align waves.xyz --to waves.xyz -q --transform-out free.txt -o out.pcd
aligned 0 waves.xyz --to waves.xyz --max-distance 900 --transform-out beyond.txt --sure
grep -q 'waves.xyz: is 52.* long, so that --max-distance 900 is no limit' err
cmp free.txt beyond.txt
