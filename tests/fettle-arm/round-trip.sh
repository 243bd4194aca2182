# Joints that --inverse finds bring the tool back to its path by --forward, with a track that is fixed or follows and a table that turns.
# Reference: the path itself (x y z are floats: 1e-4 mm).
robots=$SAMPLES/robots
path=$SAMPLES/paths/keel.pcd
read -r length width < <(awk 'data { if (n++) l += sqrt(($1 - x)^2 + ($2 - y)^2 + ($3 - z)^2); else first = $2; x = $1; y = $2; z = $3 }
    $1 == "DATA" { data = 1 } END { print l, y - first }' "$path")
there_and_back() { # ROBOT OPTION…
    local robot=$1
    shift
    fettle-arm "$robots/$robot" --inverse "$path" --feed 50 --report r.json "$@" >joints.pcd
    fettle-arm "$robots/$robot" --forward joints.pcd --report back.json >back.pcd
    fettle-diff --tol 2e-4 joints.pcd back.pcd
    jq -e --argjson length "$length" '.reached == 61 and .jumps == [] and (.time * 50 - $length | fabs) < 0.01' r.json >/dev/null
    # what --forward says of the joints is what --inverse said
    diff <(jq 'del(.track, .table) | .joints[].max_speed |= (. * 1e6 | round) | .joints[].max_acceleration |= 0 | .joints[].max_acceleration_at |= 0' r.json) \
         <(jq '.joints[].max_speed |= (. * 1e6 | round) | .joints[].max_acceleration |= 0 | .joints[].max_acceleration_at |= 0' back.json)
}
there_and_back irb1400.json
jq -e '.track.follows | not' r.json >/dev/null
there_and_back irb1400.json --track 900
jq -e '(.track.value - 900 | fabs) < 1e-9 and (.joints[6].max - 900 | fabs) < 1e-9' r.json >/dev/null
there_and_back irb1400.json --track follow:-100
jq -e --argjson width "$width" '.track.follows and (.joints[6].max - .joints[6].min - $width | fabs) < 1e-3' r.json >/dev/null
there_and_back irb1400_table.json --track 1000 --table 30
jq -e '(.table.value - 30 | fabs) < 1e-9 and (.joints[7].max - 30 | fabs) < 1e-9' r.json >/dev/null
# the same bytes for any number of threads
fettle-arm "$robots/irb1400_table.json" --inverse "$path" --threads 1 >1.pcd
fettle-arm "$robots/irb1400_table.json" --inverse "$path" --threads 3 >3.pcd
cmp 1.pcd 3.pcd
