# The viewpoint that writers put who know none, 0 0 0 1 0 0 0, is unknown, and stays so wherever a cloud is moved; one that is known moves with it, at the
# origin, too, as `VIEWPOINT 0 0 0 -1 0 0 0` or a scanner's own format states it. Reference: half a sphere 20 mm above the origin, laid by hand.
cap() { # VIEWPOINT
    awk -v view="$1" 'BEGIN { n = 2000; print "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH " n "\nHEIGHT 1\nVIEWPOINT " view "\nPOINTS " n "\nDATA ascii"
        for (i = 0; i < n; ++i) { z = (i + 0.5) / n; r = sqrt(1 - z * z); a = 2.399963 * i; print 10 * r * cos(a), 10 * r * sin(a), 20 + 10 * z } }'
}
printf '1 0 0 5\n0 1 0 0\n0 0 1 0\n0 0 0 1\n' > shift.txt
moved() { # VIEWPOINT, that of the moved cloud, that of the cloud moved back, what says where outside is
    cap "$1" > cloud.pcd
    fettle-place cloud.pcd --matrix shift.txt --inverse back.txt --ascii -o placed.pcd
    fettle-align cloud.pcd --to cloud.pcd --start shift.txt --iterations 0 --ascii -q -o aligned.pcd
    fettle-place placed.pcd --matrix back.txt --ascii -o back.pcd
    grep -qx "VIEWPOINT $2" placed.pcd
    grep -qx "VIEWPOINT $2" aligned.pcd
    grep -qx "VIEWPOINT $3" back.pcd
    fettle-reconstruct placed.pcd --report report.json -o mesh.ply
    jq -e --arg by "$4" '.outside_by == $by' report.json > ok
}
moved '0 0 0 1 0 0 0' '0 0 0 1 0 0 0' '0 0 0 1 0 0 0' guessed
moved '0 0 0 -1 0 0 0' '5 0 0 1 0 0 0' '0 0 0 -1 0 0 0' viewpoint
moved '0 0 -7 1 0 0 0' '5 0 -7 1 0 0 0' '0 0 -7 1 0 0 0' viewpoint
# Which side of a face is up follows from the viewpoint: a plate that is seen from below turns over. Where it states none the side is a guess, and said to be one.
plate() { cap "$1" | awk 'data { $3 = 20 } /^DATA/ { data = 1 } { print }'; }
plate '0 0 0 -1 0 0 0' > seen.pcd
fettle-place seen.pcd --up plane --report seen.json -o up.pcd 2>said
jq -e '.up[2] < -0.99' seen.json > ok
[ ! -s said ]
plate '0 0 0 1 0 0 0' > unseen.pcd
fettle-place unseen.pcd --up plane -o up.pcd 2>said
grep -q 'unseen.pcd: has neither normals nor a viewpoint: which side is up is a guess' said
