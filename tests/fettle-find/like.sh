# A casting of the same kind comes again: yesterday's jobs are found on today's part, which lies elsewhere, without a doubt; a place where nothing stands any
# more is named. Reference: today's part without its bead and burr; the part turned by a known motion.
# shellcheck source=tests/fettle-find/part.bash
. "$HERE/part.bash"
settings=$SAMPLES/jobs/hammer.json
hammer -o yesterday.stl
fettle-find yesterday.stl --jobs jobs --template "$settings" --min-height 1 --report yesterday.json -o found.pcd || [ $? = 1 ]
count=$(jq '[.anomalies[] | select(.job != "")] | length' yesterday.json)
[ "$count" -ge 1 ]
[ -s jobs/part.pcd ]
turn="--turn x,20,z,35"
# shellcheck disable=SC2086 # words
fettle-place yesterday.stl $turn -o today.stl
fettle-find today.stl --like jobs --jobs again --min-height 1 --report today.json -o found.pcd || [ $? = 1 ]
jq -e --argjson count "$count" '[.anomalies[] | select(.like != null)] | length == $count and all(.[]; .doubt == "" and .job != "")' today.json > ok
jq -e '.absent == null' today.json > ok
# Nothing stands out of B: the earlier job's B goes around all of it.
# shellcheck disable=SC2086
hammer --without-anomaly | fettle-place - $turn -o truth.stl
row=$(jq '[.anomalies[] | select(.like != null)] | max_by(.height) | .anomaly' today.json)
fettle-compare today.stl --to truth.stl --within "again/$row.json" --tolerance 9 --report errors.json -o errors.pcd
jq -e '.regions | .inside.max > 2 and .around.max < 0.1' errors.json > ok
# A part without anomalies has none of them.
fettle-find truth.stl --like jobs --min-height 1 --report none.json -o found.pcd || [ $? = 1 ]
jq -e --argjson count "$count" '(.absent | length) == $count and all(.anomalies[]; .like == null)' none.json > ok
mkdir empty
"$HERE/../refuses" 'empty: has no job' fettle-find today.stl --like empty
"$HERE/../refuses" '--jobs: is the folder of --like: the earlier jobs would be lost' fettle-find today.stl --like jobs --jobs jobs
