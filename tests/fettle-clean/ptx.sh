# Scans as terrestrial scanners write them: moved by their matrices, without echo NaN, organised, colours kept. Reference: points laid by hand.
scan() { # COLUMNS ROWS X Y Z: turned by 90 degrees about z, then shifted
    printf '%s\n%s\n%s %s %s\n0 1 0\n-1 0 0\n0 0 1\n0 1 0 0\n-1 0 0 0\n0 0 1 0\n%s %s %s 1\n' "$1" "$2" "$3" "$4" "$5" "$3" "$4" "$5"
}
(scan 2 3 10 20 30
    printf '%s\n' '1 0 0 0.5 255 0 0' '2 0 0 0.5 0 255 0' '0 0 0 0 0 0 0' '1 5 0 0.25 0 0 255' '2 5 0 0.25 1 2 3' '3 5 1 0.25 4 5 6') > one.ptx
fettle-clean one.ptx --ascii > one.pcd
sed '1,/^DATA/d' one.pcd | cut -d ' ' -f 1-4 > points
printf '%s\n' '10 21 30 0.5' '10 22 30 0.5' '5 21 30 0.25' '5 22 30 0.25' '5 23 31 0.25' | cmp - points
grep -q '^FIELDS x y z intensity rgb$' one.pcd
sed '1,/^DATA/d' one.pcd | cut -d ' ' -f 5 | tr '\n' ' ' | grep -q '^16711680 65280 255 66051 263430 $'
# what is no filter keeps the order: three rows in each of two columns
fettle-place one.ptx -o whole.pcd
grep -a -q '^WIDTH 3$' whole.pcd
grep -a -q '^VIEWPOINT 10 20 30 ' whole.pcd
# Two scans in a file, one of them without colours: they have no common viewpoint.
(cat one.ptx; scan 1 2 0 0 0; printf '7 8 9 1\n0 0 0 0\n') > two.ptx
fettle-clean two.ptx --report two.json --ascii | sed '1,/^DATA/d' | tail -n 1 | grep -q '^-8 7 9 1$'
jq -e '.points == 8 and .invalid == 2' two.json > ok
fettle-place two.ptx | grep -a -q '^VIEWPOINT 0 0 0 1 0 0 0$'
refuse() { "$HERE/../refuses" "$@"; }
head -n 14 one.ptx > cut.ptx
refuse 'cut.ptx: the scan ends after 14 lines' fettle-clean cut.ptx
sed '7s/.*/2 0 0 0/' one.ptx > wide.ptx
refuse 'wide.ptx: line 10: the matrix is no rotation and translation' fettle-clean wide.ptx
sed '1s/.*/0/' one.ptx > none.ptx
refuse "none.ptx: line 1: expected the number of columns, got '0'" fettle-clean none.ptx
sed '12s/.*/1 2 three 4/' one.ptx > words.ptx
refuse "words.ptx: line 12: expected x y z intensity [r g b], got '1 2 three 4'" fettle-clean words.ptx
sed '11s/255/300/' one.ptx > bright.ptx
refuse 'bright.ptx: line 11: a colour is a number from 0 to 255, got 300' fettle-clean bright.ptx
sed '1s/.*/16777216/; 2s/.*/16777216/' one.ptx > huge.ptx
refuse 'huge.ptx: the scan ends after 16 lines' fettle-clean huge.ptx
sed '19s/.*/0 0/' two.ptx > narrow.ptx
refuse "narrow.ptx: line 19: expected 3 numbers, got '0 0'" fettle-clean narrow.ptx
