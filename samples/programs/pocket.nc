%
(A pocket of 60 x 40 mm with round corners, two levels, and a ring around an island)
(Ball-nose cutter of 6 mm; zero at the lower left corner of the stock's upper side)
N10 G21 G90 G17 G40 G49 G80 G94
N20 T1 M6
N30 S9000 M3
N40 G54 G64 P0.01
N50 G0 G43 H1 Z15
N60 X40 Y30 M8
N70 Z1
N80 G1 Z0 F900
N90 G3 I-6 Z-2 (down in turns around the centre of the pocket)
N100 G3 I-6 Z-4
N110 G3 I-6
N120 G1 X50 Y20
N130 G1 X60
N140 G3 X63 Y23 R3
N150 G1 Y37
N160 G3 X60 Y40 R3
N170 G1 X20
N180 G3 X17 Y37 R3
N190 G1 Y23
N200 G3 X20 Y20 R3
N210 G1 X50
N220 G91 G1 Y-5 (the outer contour, 5 mm farther out)
N230 X10
N240 G3 X8 Y8 I0 J8
N250 G1 Y14
N260 G3 X-8 Y8 J0 I-8
N270 G1 X-40
N280 G3 X-8 Y-8 R8
N290 G1 Y-14
N300 G3 X8 Y-8 R8
N310 G1 X30
N320 G90 G0 Z15
N330 G18 X25 Y30 (a groove that dips in the plane of X and Z)
N335 G0 Z1
N340 G1 Z-2 F300
N350 G2 X55 R40 F600
N360 G17 G0 Z15 M9
N370 M5
N380 M30
%
