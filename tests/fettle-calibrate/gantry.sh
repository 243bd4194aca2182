# A gantry whose material is removed .7 times as easily as its job says: from the trace of one run and the part before and after come the
# coefficient within 5 %, the exponent of the force within .1 of Preston's, the spring, the grinding ratio. References: the law, spring and
# grinding ratio of the simulated machine.
# shellcheck source=tests/fettle-grind/stock.bash
. "$HERE/../fettle-grind/stock.bash"
make_job 0
make_stock 4
fettle-grind plan.json --stock stock.stl --cell 0.1 --removal-factor 0.7 --trace trace.pcd > ground.pcd
fettle-calibrate trace.pcd --job job.json --cell 0.1 --before stock.stl --after ground.pcd --report law.json > learnt.json
jq -e '.gantry | (.coefficient / 0.7 - 1 | fabs) < 0.05 and (.stiffness / 10 - 1 | fabs) < 1e-3 and (.preload | fabs) < 1e-3 and
    (.compliance | fabs) < 1e-3 and .height_error < 0.01' law.json > ok
# Wang's part 1 on the machine with inertia: its wheel wears by a sixtieth of what it takes, and is dragged by .4 of the normal force, which
# alone removes: in deep cuts with the drag and against it the same vertical force removes .95 and 1.4 times as much.
fettle-part "$SAMPLES/parts/wang1.json" > part.stl
fettle-sample "$SAMPLES/jobs/wang1.json" --on part.stl --strategy wang | fettle-fit "$SAMPLES/jobs/wang1.json" | fettle-plan "$SAMPLES/jobs/wang1.json" > part-plan.json
fettle-grind part-plan.json --stock part.stl --gantry virtual:dynamic --machine "$SAMPLES/machines/full_scale.json" --trace part-trace.pcd > part.pcd
fettle-calibrate part-trace.pcd --job "$SAMPLES/jobs/wang1.json" --before part.stl --report part-law.json -q > ok
jq -e '.gantry | (.grinding_ratio / 60 - 1 | fabs) < 0.05 and .grinding_ratio_sigma < 2 and (.tangential / 0.4 - 1 | fabs) < 0.15' part-law.json > ok
jq -e --slurpfile job "$SAMPLES/jobs/wang1.json" \
    '.gantry.coefficient / ($job[0].removal.coefficient * pow(25.4; 3) / 4.4482216152605) - 1 | fabs < 0.05' part-law.json > ok
jq -e '.parameters[] | select(.name == "force") | (.mean - 1 | fabs) < 0.05 and .determined == "measured"' part-law.json > ok
jq -e '.parameters[] | select(.name == "force") | (.mean - 1 | fabs) < 0.1 and .determined == "measured"' law.json > ok
# Without the part after, the same passes.
fettle-calibrate trace.pcd --job job.json --cell 0.1 --before stock.stl --report before.json > ok
jq -e --slurpfile law law.json '.gantry.coefficient == $law[0].gantry.coefficient and (.gantry | has("compliance") | not)' before.json > ok
