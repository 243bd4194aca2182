# The hammer with its anomalies, sampled 1 mm apart where the chain takes 0.5: half the points for fettle-find to search.
hammer() { # ARGUMENTS of fettle-part
    jq --arg scan "$SAMPLES/scans/hammer.stl" '.scan.file = $scan | .step = 1' "$SAMPLES/parts/hammer.json" | fettle-part - "$@"
}
