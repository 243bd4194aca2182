# The ledge in a hole of a plate that is bent by 1.5 mm, against its design, is no anomaly: metal bends and hardly strains, so that the ledge, which a few points show, has its
# place from the plate around it. Reference: the design, and that nothing was added. Without strains it is found .4 mm high, and said .99. The pose is a registration's.
find-case "$SAMPLES/designs/plate.stl" --scale 1 --up z --cell 1.2 --sigma 0.05 --number 100 --bend 1.5 --design design.stl -q -o bent.pcd
cat > pose.txt <<'P'
0.9999932451069441 -0.00043008874067443294 -0.0036503101455080044 0.099878738761684391
0.00043261830795202083 0.99999966684195796 0.00069221194199506483 -0.092306409179230844
0.003650011216815411 -0.00069378645717607429 0.9999930980154158 0.51337309096225758
0 0 0 1
P
fettle-find bent.pcd --against design.stl --transform-in pose.txt --report found.json > found.pcd
jq -e '.anomalies == []' found.json > ok
