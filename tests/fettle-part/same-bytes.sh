# Same input, same bytes, for any number of threads; another seed only matters where there is noise.
jq '.noise = "normal:0.01"' "$SAMPLES/parts/wang3.json" >noisy.json
fettle-part noisy.json --threads 1 -o a.stl
fettle-part - --threads 2 <noisy.json >b.stl
cmp a.stl b.stl
! cmp -s a.stl <(fettle-part noisy.json --seed 2) || exit 1
cmp <(fettle-part "$SAMPLES/parts/wang3.json") <(fettle-part "$SAMPLES/parts/wang3.json" --seed 2)
