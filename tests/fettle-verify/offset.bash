# shellcheck shell=bash
# An OFF mesh of z = SLOPE x + LIFT over x, y from A to B, in N cells a side.
ramp() { # SLOPE LIFT A B N
    awk -v m="$1" -v l="$2" -v a="$3" -v b="$4" -v n="$5" 'BEGIN { OFMT = "%.15g"
        print "OFF"; print (n + 1) ^ 2, 2 * n * n, 0
        for (j = 0; j <= n; j++) for (i = 0; i <= n; i++) { x = a + (b - a) * i / n; print x, a + (b - a) * j / n, m * x + l }
        for (j = 0; j < n; j++) for (i = 0; i < n; i++) { k = j * (n + 1) + i
            print 3, k, k + 1, k + n + 2; print 3, k, k + n + 2, k + n + 1 } }'
}
