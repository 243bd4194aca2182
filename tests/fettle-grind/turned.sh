# Part and job turned by 30 degrees about Z, with theta turned along, are the same work. Reference: the identity; the
# coordinates of a PCD are floats, 1e-6 of their size.
# shellcheck source=tests/fettle-grind/stock.bash
. "$HERE/stock.bash"
for theta in 0 30; do
    make_job $theta
    awk -v theta=$theta 'BEGIN { a = theta * 3.141592653589793 / 180
        print "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 10201\nHEIGHT 1"
        print "VIEWPOINT 0 0 0 1 0 0 0\nPOINTS 10201\nDATA ascii"
        for (i = -50; i <= 50; i++) for (j = -50; j <= 50; j++) {
            x = 0.4 * i; y = 0.4 * j; r = (x * x + y * y) / 25
            printf "%.9g %.9g %.9g\n", x * cos(a) - y * sin(a), x * sin(a) + y * cos(a), 5 + (r < 1 ? 3 * (1 - r) ^ 2 : 0)
        } }' > stock.pcd
    fettle-grind plan.json --stock stock.pcd --report $theta.json > ground.pcd
done
jq -e -n --slurpfile a 0.json --slurpfile b 30.json '$a[0] as $a | $b[0] as $b |
    ($a.removed_volume / $b.removed_volume - 1 | fabs) < 1e-5 and ($a.machine_time / $b.machine_time - 1 | fabs) < 1e-5 and
    $a.layers == $b.layers and $a.steps == $b.steps and $a.raises == $b.raises and $a.removed_volume > 20' > ok
