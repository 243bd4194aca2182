# Files that are not there, are none, or hold nonsense: status 2, one line, nothing on stdout. Reference: by hand.
p="$HERE/two-points.pcd"
refuses() {
    local status=0
    fettle-diff "$@" > stdout 2> stderr || status=$?
    test $status = 2 && test ! -s stdout && test "$(wc -l < stderr)" = 1
    cut -c 1-100 stderr
}
touch empty
mkdir folder
echo hello > words
cat "$p" "$p" > twice.pcd
{ sed 's/ascii/binary/' "$p"; } > mixed.pcd
{
    refuses "$p" nowhere.pcd
    refuses "$p" folder
    refuses "$p" ''
    refuses "$p" "$(printf '%5000s' | tr ' ' a)"
    refuses "$p" empty
    refuses "$p" words
    refuses "$p" twice.pcd
    refuses "$p" mixed.pcd
    refuses twice.pcd "$p"
    cat "$p" "$p" | refuses "$p" -
    refuses "$p" - <&-
    mkfifo pipe
    { exec 3> pipe; } &
    refuses "$p" pipe
    wait
    echo '{"a": 1, "a": 2}' > twice.json
    refuses twice.json "$p"
}
