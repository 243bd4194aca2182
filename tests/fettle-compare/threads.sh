# Any number of threads writes the same bytes: a wavy grid against itself, moved.
wavy() { awk -v lift="$1" 'BEGIN { for (i = 0; i < 60; i++) for (j = 0; j < 60; j++) print i, j, sin(i / 7) + cos(j / 5) + lift * i * j }'; }
wavy 0 >reference.xyz
wavy 1e-4 >test.xyz
for threads in 1 2 3; do
    fettle-compare test.xyz --to reference.xyz --threads $threads --report $threads.json >$threads.pcd
done
cmp 1.pcd 2.pcd && cmp 1.pcd 3.pcd
cmp 1.json 2.json && cmp 1.json 3.json
