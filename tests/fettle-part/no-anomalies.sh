# A part without anomalies: the member may be left out, or be empty. Reference: the same bytes.
jq '.anomalies = []' "$SAMPLES/parts/hill.json" >empty.json
jq 'del(.anomalies)' empty.json >none.json
fettle-part empty.json >empty.stl
fettle-part none.json | cmp empty.stl -
