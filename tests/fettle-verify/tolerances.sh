# Exit 1 only for over-cut beyond the inner tolerance; material left beyond the outer one is a class, no failure.
# shellcheck source=tests/fettle-verify/offset.bash
. "$HERE/offset.bash"
ramp 0 0 -1 11 3 > design.off
ramp 0 0.2 0 10 10 > high.off
ramp 0 -0.2 0 10 10 > low.off
verdict() { # CLASS STATUS ARGUMENT...
    local class=$1 expected=$2 status=0
    shift 2
    fettle-verify "$@" --design design.off --report report.json > patches.pcd || status=$?
    [ $status = "$expected" ]
    jq -e --arg class "$class" '.classes[$class].count == 200' report.json > ok
}
verdict serious_under_cut 0 high.off --tolerance 0.1
verdict slight_under_cut 0 high.off --tolerance 0.1 --outer-tolerance 0.3
verdict neutral 0 high.off --tolerance 0.3 --neutral 0.9
verdict serious_over_cut 1 low.off --tolerance 0.1
verdict slight_over_cut 0 low.off --tolerance 0.1 --inner-tolerance 0.3
verdict serious_over_cut 1 low.off --inner-tolerance 0.1 --tolerance 0.3
