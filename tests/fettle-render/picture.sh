# A part and its error map become PNGs of the stated size, the same bytes for any number of threads. Reference: the PNG signature; the width
# 1294 = margin 84 + map 900 + legend 310, the height of a square map 880 = 78 + 680 + 122, big-endian in bytes 17 to 24.
fettle-part "$SAMPLES/parts/wang1.json" -o stock.stl
fettle-part "$SAMPLES/parts/wang1.json" --without-anomaly -o truth.stl
fettle-render stock.stl --within "$SAMPLES/jobs/wang1.json" --title 'Part 1' -o before.png
[ "$(head -c 8 before.png | od -An -tx1 | tr -d ' ')" = 89504e470d0a1a0a ]
[ "$(head -c 24 before.png | tail -c 8 | od -An -tx1 | tr -d ' ')" = 0000050e00000370 ]
cmp before.png <(fettle-render --threads 1 --within "$SAMPLES/jobs/wang1.json" --title 'Part 1' <stock.stl)

fettle-part --cloud "$SAMPLES/parts/wang1.json" | fettle-compare - --to truth.stl >errors.pcd
fettle-render errors.pcd -o a.png
fettle-render errors.pcd --field error -o b.png
fettle-render errors.pcd --field z -o c.png
cmp a.png b.png # an error map is drawn as one
! cmp -s a.png c.png || exit 1

# from any direction: any length of it is the same, straight above is what is drawn without
fettle-render errors.pcd --from 0,0,2 | cmp - a.png
fettle-render errors.pcd --from 1,-2,0.5 -o d.png
fettle-render errors.pcd --from 0.1,-0.2,0.05 --threads 1 | cmp - d.png
! cmp -s a.png d.png || exit 1
