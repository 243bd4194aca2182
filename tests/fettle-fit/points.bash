# Sourced by the cases.

# job TYPE [MORE]: a job in inches around a 1.4 x 1.4 in anomaly; MORE are members of "surface"
job() {
    echo '{"kind": "job", "units": {"length": "in"}, "surface": {"type": "'"$1"'"'"${2:-}"'},
      "anomaly": [[-0.7, -0.7], [0.7, -0.7], [0.7, 0.7], [-0.7, 0.7]],
      "sampling": [[-2, -2], [2, -2], [2, 2], [-2, 2]], "probe": {"accuracy": 1e-4}}'
}

# pcd FIELDS...: the lines of stdin as an ASCII PCD of F4, in inches
pcd() {
    local rows
    rows=$(cat)
    local count
    count=$(wc -l <<<"$rows")
    printf '# units in\nVERSION 0.7\nFIELDS %s\nSIZE %s\nTYPE %s\nCOUNT %s\nWIDTH %d\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS %d\nDATA ascii\n' \
        "$*" "${*//[a-z]*/4}" "${*//[a-z]*/F}" "${*//[a-z]*/1}" "$count" "$count"
    echo "$rows"
}

# heights FORMULA COUNT SEED: x y z of scattered places within 1.5 in, z by an awk formula of x and y
heights() {
    awk -v n="$2" -v seed="$3" "BEGIN { srand(seed); for (i = 0; i < n; ++i) {
        x = 3 * rand() - 1.5; y = 3 * rand() - 1.5; printf \"%.9f %.9f %.9f\\n\", x, y, $1 } }"
}

# touches: the lines of stdin, x y z, as touches near the anomaly, in inches
touches() {
    sed 's/$/ 1/' | pcd x y z role
}
