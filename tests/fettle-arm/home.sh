# The makers' home poses, all joints 0: flange at 955 0 1195 (IRB 1400) and 940 0 1455 (IRB 2400), looking ahead; the tip of the tool
# is 200 ahead of it and 100 down. A track carries it along, a table turns the part against it.
joints() { # FIELDS VALUES
    printf 'VERSION 0.7\nFIELDS x y z %s\nSIZE 4 4 4%s\nTYPE F F F%s\nCOUNT 1 1 1%s\nWIDTH 1\nHEIGHT 1\nPOINTS 1\nDATA ascii\n0 0 0 %s\n' \
        "$1" "$(sed 's/[a-z0-9]*joint[0-9]/8/g' <<<" $1")" "$(sed 's/joint[0-9]/F/g' <<<" $1")" "$(sed 's/joint[0-9]/1/g' <<<" $1")" "$2"
}
six='joint1 joint2 joint3 joint4 joint5 joint6'
at() { # ROBOT X Y Z, joints on stdin
    fettle-arm "$SAMPLES/robots/$1.json" --forward --ascii | awk -v x="$2" -v y="$3" -v z="$4" '
        data { exit !(($1 - x)^2 + ($2 - y)^2 + ($3 - z)^2 < 1e-6) } $1 == "DATA" { data = 1 }'
}
joints "$six" '0 0 0 0 0 0' | at irb2400 1140 0 1355
joints "$six joint7" '0 0 0 0 0 0 0' | at irb1400 1155 0 1095
joints "$six joint7" '0 0 0 0 0 0 1500' | at irb1400 1155 1500 1095
# the same in inches: 59.0551181 in along the track
joints "$six joint7" '0 0 0 0 0 0 59.0551181' | sed '1i # units in' | at irb1400 45.472441 59.055118 43.110236
joints "$six joint7 joint8" '0 0 0 0 0 0 1000 0' | at irb1400_table 1155 1000 1095
# the table's axis is at 1000 1000: a quarter turn of it takes 155 along x to -155 along y of the part
joints "$six joint7 joint8" '0 0 0 0 0 0 1000 90' | at irb1400_table 1000 845 1095
# joints alone are enough: x y z are what is to be found
joints "$six joint7" '0 0 0 0 0 0 1500' | sed '/^FIELDS/s/ x y z//; /^SIZE/s/ 4 4 4//; /^TYPE/s/ F F F//; /^COUNT/s/ 1 1 1//; s/^0 0 0 //' | at irb1400 1155 1500 1095
joints "$six" '0 0 0 0 0 0' >six.pcd
"$HERE/../refuses" "six.pcd: the points have no field 'joint7'" fettle-arm "$SAMPLES/robots/irb1400.json" --forward six.pcd </dev/null
