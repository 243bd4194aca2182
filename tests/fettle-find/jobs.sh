# A part that lies anyhow gets a job for each anomaly: in its frame the anomaly faces up, B is around all of it, S on good metal, and the
# chain runs. Doubtful rows have none until a person decides. Reference: the part without its bead and burr.
# shellcheck source=tests/fettle-find/part.bash
. "$HERE/part.bash"
turn="--turn x,140,z,35"
# shellcheck disable=SC2086 # words
hammer | fettle-place - $turn -o worn.stl
# shellcheck disable=SC2086
hammer --without-anomaly | fettle-place - $turn -o truth.stl
settings=$SAMPLES/jobs/hammer.json
fettle-find worn.stl --jobs jobs --template "$settings" --report found.json -o found.pcd || [ $? = 1 ]
jq -c '[.anomalies[] | [.anomaly, .height, .doubt, .job]]' found.json
row=$(jq '.anomalies | max_by(.height) | .anomaly' found.json)
job=jobs/$row.json
# Nothing of bead and burr is left out of B, and S lies beside them.
fettle-compare worn.stl --to truth.stl --within "$job" --tolerance 9 --report worn.json -o worn.pcd
jq -c '.regions | [.inside.max, .around.max, .outside.max]' worn.json
jq -e '.regions | .inside.max > 2 and .around.max < 0.1 and .outside.max < 0.1' worn.json > ok
# The mean normal of the metal around B is the job's z.
fettle-place worn.stl --into "$job" -o turned.stl
fettle-sample "$job" --on worn.stl --noise normal:0.127 --seed 1 > samples.pcd
fettle-fit "$job" samples.pcd > surface.json
fettle-mesh surface.json --within "$job" --step 1 --stl > desired.stl
fettle-compare desired.stl --to truth.stl --within "$job" --tolerance 0.4 --report fit.json -o fit.pcd
jq -c '.regions.inside | [.mean, .min, .max]' fit.json
# The machine's values are the template's.
for key in probe tolerance wheel force removal; do jq -e --slurpfile t "$settings" ".$key == (\$t[0].$key // .$key)" "$job" > ok; done
# Rows without a job are those with a doubt; a person keeps or drops them.
jq -e 'all(.anomalies[]; (.doubt == "") == (.job != ""))' found.json > ok
doubtful=$(jq -r '[.anomalies[] | select(.doubt != "") | .anomaly] | join(",")' found.json)
if [ -n "$doubtful" ]; then
    fettle-find worn.stl --jobs all --template "$settings" --keep "$doubtful" --report all.json -o all.pcd
    jq -e --slurpfile found found.json 'all(.anomalies[]; .job != "") and (.anomalies | length) == ($found[0].anomalies | length)' all.json > ok
    fettle-find worn.stl --jobs jobs --template "$settings" --drop "$doubtful" --report kept.json -o kept.pcd
    cmp "$job" "all/$row.json"
fi
touch jobs/99.json
fettle-find worn.stl --jobs jobs --template "$settings" --report found.json -o found.pcd 2> said || [ $? = 1 ]
grep -q 'jobs/99.json: not of this run' said
"$HERE/../refuses" '--jobs: --jobs and --template go together' fettle-find worn.stl --jobs jobs
"$HERE/../refuses" '--template: --jobs and --template go together' fettle-find worn.stl --template "$settings"
# Metal that scatters by more than the tolerance does not show what is to be ground to.
jq '.tolerance = 0.001' "$settings" > fine.json
fettle-find worn.stl --min-height 0.5 --jobs fine --template fine.json --report fine-found.json -o found.pcd || [ $? = 1 ]
jq -e '.anomalies | length > 0 and all(.[]; (.doubt | test("scatters by .* more than the tolerance of --template, 0.001 mm")) and .job == "")' fine-found.json > ok
