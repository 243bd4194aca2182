# JSON is compared member by member, in any order; texts exactly, numbers within the tolerance. By hand.
echo '{"kind": "x", "list": [1, 2.0, {"deep": null}], "empty": []}' > a.json
echo '{"list": [1, 2.5, {"deep": null}], "kind": "x", "empty": {}, "more": true}' > b.json
fettle-diff a.json a.json
! fettle-diff --tol 0.5 a.json b.json || exit 1
! fettle-diff --tol 0.5 b.json a.json || exit 1
sed 's/{}/[]/; s/, "more": true//' b.json > c.json
! fettle-diff --tol 0.4 a.json c.json || exit 1
fettle-diff --tol 0.5 a.json c.json
