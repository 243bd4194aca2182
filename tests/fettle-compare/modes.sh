# Three ways to measure over a plane of slope 3/4. Reference: the height over it is 1; across it 0.8; along (0, 0.6, 0.8),
# which leaves the plane at the angle whose cosine is 0.8 · 0.8 - 0.6 · 0.6 = 0.28, 0.8 / 0.28.
printf 'v -90 -90 -67.5\nv 90 -90 -67.5\nv 90 90 67.5\nv -90 90 67.5\nf 1 2 3 4\n' >slope.obj
printf '0 4 4\n1 0 1\n' >test.xyz
measure() { fettle-compare test.xyz --to slope.obj --ascii "$@" | sed '1,/^DATA/d' | cut -d ' ' -f 7; }
measure
measure --mode z
measure --mode direction --direction 0,6,8
