# One thread and two write the same bytes. Reference: each other.
fettle-part --without-anomaly "$SAMPLES/parts/wang2.json" > design.stl
for n in 1 2; do fettle-finish design.stl --file-units in --cutter taper:12,20,2 --scallop 0.1 --threads $n > $n.nc; done
cmp 1.nc 2.nc
