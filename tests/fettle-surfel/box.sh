# A box of 20 x 10 x 5 mm under 0.3 mm of stock: the middles of whole millimetres on its faces, and half-millimetres along
# its edges, on either face; every displacement is 0.3. The same bytes with one thread and two, from mm and from metres.
# Reference: counted by hand, 2 (20 · 10 + 20 · 5 + 10 · 5) and 2 · 2 · 4 (20 + 10 + 5); the surfel inside nearest to an edge is
# half a millimetre from it, less than half a cell's diagonal.
# shellcheck source=tests/fettle-surfel/box.bash
. "$HERE/box.bash"
box 0 0 0 20 10 5 > design.off
box -0.3 -0.3 -0.3 20.3 10.3 5.3 > stock.off
for n in 1 2; do fettle-surfel design.off --stock stock.off --spacing 1 --threads $n --report $n.json > $n.pcd; done
cmp 1.pcd 2.pcd
cmp 1.json 2.json
jq -e '.surfels == 1260 and .on_edges == 560 and .shrunk == 256 and .patches == 6 and .no_hit == 0 and .several_hits == 0 and
       (.min - 0.3 | fabs) < 1e-6 and (.max - 0.3 | fabs) < 1e-6 and .min_spacing == 1' 1.json > ok
box 0 0 0 0.02 0.01 0.005 > metres.off
fettle-surfel metres.off --file-units m --stock stock.off --spacing 1 | fettle-diff --tol 1e-5 - 1.pcd
# 0.3 mm along the edges: between two a millimetre apart 3 new ones. Nothing inside is nearer than 0.15 mm.
fettle-surfel design.off --stock stock.off --spacing 1 --edge-spacing 0.3 --report fine.json > fine.pcd
jq -e '.on_edges == 1120 and .surfels == 1820' fine.json > ok
