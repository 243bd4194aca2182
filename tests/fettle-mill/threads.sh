# One thread and two write the same bytes. Reference: each other.
for n in 1 2; do
    fettle-mill "$SAMPLES/programs/pocket.nc" --stock box:0,0,-12,80,60,0 --cutter taper:6,15,1 --step 0.1 --threads $n \
        --report $n.json > $n.stl
done
cmp 1.stl 2.stl
cmp 1.json 2.json
