# A part in metres that is read in mm, and one in mm that is read in m, are drawn, with a warning. Reference: the sizes.
awk 'BEGIN { for (i = 0; i < 60; i++) for (j = 0; j < 40; j++) print 2 * i, 2 * j, 10 + 5 * sin(i / 9) * cos(j / 7) }' >mm.xyz
awk '{ print $1 / 1000, $2 / 1000, $3 / 1000 }' mm.xyz >metres.xyz
fettle-render mm.xyz -o mm.png 2>err
[ ! -s err ]
fettle-render metres.xyz -o metres.png 2>err
grep -qE '^fettle-render: warning: metres.xyz: the part, [0-9.]+ x [0-9.]+ x [0-9.]+ mm, is under 5 mm long: is its unit right\?$' err
fettle-render metres.xyz --file-units m -o metres.png 2>err
[ ! -s err ]
awk '{ print $1 * 1000, $2 * 1000, $3 * 1000 }' mm.xyz >micrometres.xyz
fettle-render micrometres.xyz -o far.png 2>err
grep -q 'is over 100 m long: is its unit right?$' err
fettle-render metres.xyz -o metres.png -q 2>err
[ ! -s err ]
# Few points may be touches, of any size.
head -5 metres.xyz | fettle-render -o few.png 2>err
[ ! -s err ]
