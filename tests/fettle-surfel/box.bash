# box X0 Y0 Z0 X1 Y1 Z1: a box, OFF, to be sourced by the cases.
box() {
    awk -v x0="$1" -v y0="$2" -v z0="$3" -v x1="$4" -v y1="$5" -v z1="$6" 'BEGIN {
        print "OFF\n8 6 0"
        for (i = 0; i < 8; ++i) print (i % 2 ? x1 : x0), (int(i / 2) % 2 ? y1 : y0), (i >= 4 ? z1 : z0)
        print "4 0 2 3 1\n4 4 5 7 6\n4 0 1 5 4\n4 2 6 7 3\n4 0 4 6 2\n4 1 3 7 5"
    }'
}
