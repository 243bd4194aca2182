# Where a robot reaches. Reference: its length, its symmetry along the track, and poses that joints are known for.
reach() { fettle-arm "$@" --reach --ascii | awk 'data { print $NF } $1 == "DATA" { data = 1 }'; }
jq 'del(.track)' "$SAMPLES/robots/irb1400.json" >fixed.json
# one cell about the tip at home, looking ahead; one 3 m away (the arm and its tool are 1.9 m long)
test "$(reach fixed.json --box 1105,-50,1045,1205,50,1145 | awk '{ print ($1 > 0 && $1 < 1) }')" = 1
test "$(reach fixed.json --box 2950,-50,950,3050,50,1050)" = 0
# along the track it is everywhere the same but near its ends, and no less than without it
box=600,-1000,500,1200,3000,700
fettle-arm "$SAMPLES/robots/irb1400.json" --reach --box $box --step 200 --report r.json --ascii -o track.pcd
reach fixed.json --box $box --step 200 >fixed
awk 'data { print $NF } $1 == "DATA" { data = 1 }' track.pcd | paste - fixed | awk '$1 < $2 { exit 1 }'
jq -e '.cells == 60 and .reached > 0.8 and .mean_reach > 0.3' r.json >/dev/null
jq '.base = {position: [0, 500, 0]}' fixed.json >moved.json
diff <(reach fixed.json --box 600,0,500,1200,400,700) <(reach moved.json --box 600,500,500,1200,900,700)
# the same for any number of threads; a picture of a layer
fettle-arm "$SAMPLES/robots/irb1400.json" --reach --box $box --step 200 --threads 1 --ascii | cmp - track.pcd
fettle-render track.pcd --field reach -o reach.png
# What limits it: its length far off; at its length joint ranges, that of joint 1 alone behind it; under a lid that lies on the tip always a collision.
limited() { fettle-arm "$1" --reach --box "$2" --report limits.json -q -o /dev/null; jq -c "$3" limits.json; }
test "$(limited fixed.json 2950,-50,950,3050,50,1050 .limited.by_length)" = 1
jq '.dh[0].min_deg = -20 | .dh[0].max_deg = 20 | .dh[4].min_deg = -100 | .dh[4].max_deg = 100 | .bodies = [] | .allowed = []' fixed.json >narrow.json
test "$(limited narrow.json -50,1050,750,50,1150,850 '.limited | .by_joint_ranges == 1 and .by_one_joint[0] == 1')" = true
test "$(limited fixed.json 950,-50,650,1050,50,750 .limited.by_collisions)" = 0
jq '.bodies += [{name: "lid", link: -1, shape: "box", at: {position: [1000, 0, 700]}, size: [300, 300, 300]}]' fixed.json >lid.json
test "$(limited lid.json 950,-50,650,1050,50,750 .limited.by_collisions)" = 1
