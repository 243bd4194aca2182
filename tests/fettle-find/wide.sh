# A half ellipsoid that leaves 3 mm of a bent plate around it is found, with the doubt that the surface beneath it is an extrapolation; with 7 mm
# around it there is none. Reference: the shape, 2 mm high.
bump_on() { # HALF_SIZE
    awk -v s="$1" 'BEGIN { srand(3)
        for (x = -s; x <= s; x += 0.5) for (y = -s; y <= s; y += 0.5) {
            q = (x ^ 2 + y ^ 2) / 17 ^ 2
            print x, y, x ^ 2 / 400 + (q < 1 ? 2 * sqrt(1 - q) : 0) + 0.01 * (rand() + rand() - 1) } }' > part.xyz
    fettle-find part.xyz --file-units mm --report found.json -o found.pcd -q || [ $? = 1 ]
    jq -e '.anomalies | length == 1 and (.[0].height - 2 | fabs < 0.05)' found.json > ok
}
bump_on 20
jq -e '.anomalies[0].doubt == "it is wider than the good metal around it"' found.json > ok
bump_on 24
jq -e '.anomalies[0].doubt == ""' found.json > ok
