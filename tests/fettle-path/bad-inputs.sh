# What is neither surfels nor a path, a patch that is not there, and half of --held end with status 2 and one line.
# shellcheck source=tests/fettle-surfel/box.bash
. "$HERE/../fettle-surfel/box.bash"
refused() { "$HERE/../refuses" "$@"; }
box 0 0 0 2 2 2 > box.off
fettle-surfel box.off --stock box.off -q > work.pcd
fettle-surfel box.off --stock box.off --spacing 5 -q > coarse.pcd
printf '1 2 3\n4 5 6\n' > points.xyz
: > empty.pcd
refused 'empty.pcd' fettle-path empty.pcd
refused 'points.xyz: no fields normal_x' fettle-path points.xyz
refused 'work.pcd: no surfels on patch 6' fettle-path work.pcd --patch 6
refused 'coarse.pcd: too few surfels on patch 5' fettle-path coarse.pcd # on none of the six is there enough
refused 'coarse.pcd: too few surfels on patch 0' fettle-path coarse.pcd --patch 0
refused '--approach and --part go with --clearance' fettle-path work.pcd --approach 3
refused '--clearance: over a path it needs the --part' fettle-path <(fettle-path work.pcd --patch 1) --clearance 5
refused 'joined already' fettle-path <(fettle-path work.pcd --patch 1 --clearance 5) --clearance 5 --part box.off
refused '--above, --room-for and --no-room-for go with surfels' fettle-path <(fettle-path work.pcd --patch 1) --above 0.1
refused 'work.pcd' fettle-path work.pcd --room-for work.pcd
refused '--held part and --wheel' fettle-path work.pcd --held part
refused '--held part and --wheel' fettle-path work.pcd --wheel 0,0,0,1,0,0,0
refused '--wheel: expected x,y,z,qw,qx,qy,qz, got' fettle-path work.pcd --held part --wheel 0,0,0,1
refused '--wheel: expected x,y,z,qw,qx,qy,qz, got' fettle-path work.pcd --held part --wheel 0,0,0,0,0,0,0
refused '--spacing: must be at least 0.001' fettle-path work.pcd --spacing 0
refused '--spacing: must be at least 0.001' fettle-path work.pcd --spacing 1e-9
refused '--pattern' fettle-path work.pcd --pattern circle
# What would take all memory: by the count of the rows.
refused 'work.pcd: the step-over is too fine: more than 100,000 rows' fettle-path work.pcd --step-over 1e-9
refused 'work.pcd: the step-over is too fine' fettle-path work.pcd --step-over 1e-9 --pattern spiral
box 0 0 0 6000 6000 6000 > large.off
fettle-surfel large.off --stock large.off --spacing 150 -q > large.pcd
refused 'large.pcd: the spacing is too fine: more than 5 million points' fettle-path large.pcd --step-over 100 --spacing 0.001
