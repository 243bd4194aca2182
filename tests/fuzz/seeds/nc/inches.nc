g20g91
g0x1y1z1
g1z-1f10;c
g2x1y0i.5j0
g90g1x0
