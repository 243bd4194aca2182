# A person's word: a dropped row is left out and the others keep their numbers; a kept row has no doubt. Reference: the run without.
# shellcheck source=tests/fettle-find/part.bash
. "$HERE/part.bash"
hammer -o worn.stl
fettle-find worn.stl --report all.json -o all.ply || [ $? = 1 ]
n=$(jq '.anomalies | length' all.json)
[ "$n" -ge 2 ]
fettle-find worn.stl --drop 1 --keep 2 --report left.json -o left.ply || [ $? = 1 ]
jq -e --slurpfile all all.json '.anomalies == ($all[0].anomalies[1:] | .[0].doubt = "")' left.json > ok
status=0
fettle-find worn.stl --drop "$(seq -s , "$n")" --report none.json -o none.ply || status=$?
[ $status = 0 ]
jq -e '.anomalies == []' none.json > ok
# Higher bounds leave rows out, and change none that stay.
fettle-find worn.stl --min-height 1 --report high.json -o high.ply || [ $? = 1 ]
jq -e 'all(.anomalies[]; .height >= 1)' high.json > ok
