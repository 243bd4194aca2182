# Without their anomalies Wang's parts are a plane, a cylinder and a sphere. Reference: the form errors of these are 0, but for the
# rounding of float coordinates (4 in: 2.4e-7) which the fit of a short arc enlarges.
for form in flatness:wang1 cylindricity:wang2 sphericity:wang3; do
    fettle-part --without-anomaly --cloud "$SAMPLES/parts/${form#*:}.json" | fettle-form "${form%:*}" |
        jq -e '.least_squares < 2e-6' >/dev/null
done
