# The trace of a run that was killed is read as far as it has whole points, and it is said what was left out: part of a point after the
# last one, a move whose result is not known, the end of a file that was cut. The page is that of the points before it.
# Reference: the same trace with those points alone.
# shellcheck source=tests/fettle-grind/stock.bash
. "$HERE/../fettle-grind/stock.bash"
make_job 0
make_stock 2
page() { fettle-report --plan plan.json --trace "$1" 2> message | sed -n '/data-value/p' | grep -v 'class="hash"'; }
head_with() { # ROWS FILE: the header says so many
    sed "/^DATA/q; s/^\(WIDTH\|POINTS\) .*/\1 $1/" "$2"
}
fettle-grind plan.json --stock stock.stl --cell 0.4 --trace whole.pcd --ascii > ground.pcd
sed '1,/^DATA/d' whole.pcd | awk 'NR <= 100' > rows
{ head_with 100 whole.pcd; cat rows; } > done.pcd
page done.pcd > expected
[ -s expected ]
[ ! -s message ]
same_page() { # FILE WORDS
    page "$1" > values
    cmp values expected
    [ "$(wc -l < message)" = 1 ] && grep -q "^fettle-report: warning: $1: .*$2" message || { cat message; exit 1; }
}
{ cat done.pcd; sed '1,/^DATA/d' whole.pcd | sed -n 101p; } > longer.pcd
same_page longer.pcd 'the run was killed: after 100 points '
{ cat done.pcd; printf '1 2 3 4'; } > part.pcd
same_page part.pcd 'the run was killed: after 100 points 7 bytes of another one are left out'
{ head_with 101 whole.pcd; cat rows; awk 'END { $7 = 13; print }' rows; } > begun.pcd
same_page begun.pcd 'the run was killed in the middle of a move'
{ head_with 5000 whole.pcd; cat rows; printf '1 2 3'; } > cut.pcd
same_page cut.pcd 'cut short: 100 whole points of 5000'
fettle-grind plan.json --stock stock.stl --cell 0.4 --trace binary.pcd > ground.pcd
{ cat binary.pcd; printf 'abc'; } > more.pcd
page binary.pcd > expected
same_page more.pcd 'bytes of another one are left out'
