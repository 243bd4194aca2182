# A level plate of surfels, 0.5 mm apart, as text.    plate > plate.pcd
plate() {
    awk 'BEGIN {
        n = 81
        printf "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z normal_x normal_y normal_z displacement\nSIZE 4 4 4 4 4 4 4\nTYPE F F F F F F F\n"
        printf "COUNT 1 1 1 1 1 1 1\nWIDTH %d\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS %d\nDATA ascii\n", n * n, n * n
        for (i = 0; i < n; ++i) for (j = 0; j < n; ++j) printf "%g %g 5 0 0 1 0.25\n", (i - 40) / 2, (j - 40) / 2 }'
}
wheel() { # JSON of a wheel with a crown like its own radius, on thick rubber; E = 5 MPa
    cat <<EOF
{"kind": "wheel", "units": {"length": "mm", "stress": "MPa"}, "radius": 60, "width": 50, "crown_radius": 60,
 "layer": {"thickness": $1, "young": 5, "poisson": $2}, "belt_speed": 15000, "law": {"type": "preston", "coefficient": 1e-8}}
EOF
}
