# What is wrong on the command line is said in one line, with status 2 and nothing on stdout. Reference: by hand.
p="$HERE/two-points.pcd"
refuses() {
    local status=0
    fettle-diff "$@" > stdout 2> stderr || status=$?
    test $status = 2 && test ! -s stdout && test "$(wc -l < stderr)" = 1
    cat stderr
}
{
    refuses
    refuses "$p"
    refuses --tol 1 --tol 2 "$p" "$p"
    refuses --tol
    refuses --tol= "$p" "$p"
    refuses "$p" "$p" --tol
    refuses --tol --rel 1 "$p" "$p"
    refuses --tol -1 "$p" "$p"
    refuses --tol nan "$p" "$p"
    refuses --tol 1,5 "$p" "$p"
    refuses --tol 1e400 "$p" "$p"
    refuses --tolerance 1 "$p" "$p"
    refuses --thread 1 "$p" "$p"
    refuses -x "$p" "$p"
    refuses "$p" "$p" third
    refuses --threads 0 "$p" "$p"
    refuses --threads 1000000 "$p" "$p"
    refuses --threads 1.5 "$p" "$p"
    refuses --seed -1 "$p" "$p"
    refuses -q -q "$p" "$p"
    refuses - -
} 2>&1
