# Belt grinding: a rough part as surfels, a path over it, and what the belt leaves on it.
#
#   make -f pipelines/belt.mk                                      the blade that the project makes itself, by planned feeds
#   make -f pipelines/belt.mk PLANNED=no BELT=build/belt-constant  the same by one constant feed
#   make -f pipelines/belt.mk PARTS='blade nasa handle edge' DATA=DIR
#       every piece of DIR/nasa_blade_a.stl and DIR/handle.off, and of EDGE=DIR/../before_after a leading edge before and after, LE_mesh.ply and LE_mesh_grinded.ply
#   make -f pipelines/belt.mk plan                                 feeds, and forces, that meet the blade's allowance
#   make -f pipelines/belt.mk held                                 the robot holds the blade and leads it along a fixed belt; exit 1 if something collides
#   make -f pipelines/belt.mk law                                  the removal law from measured trials; exit 1 if a figure is missed
#
# BELT/PART/stock.stl is the design with an allowance of 0.2 to 0.6 mm that varies over it, work.pcd the surfels, errors.pcd what
# would be left without grinding, surface.pcd the stock's surface with its normals, rows.pcd a path, planned.pcd with its feeds, once.pcd the surfels after it;
# rest.pcd a path over what then stands over the tolerance, twice.pcd the surfels after it; narrow.pcd that of a belt file; ground.pcd the surfels after all,
# watch.csv the errors on the way, left.pcd what is left. At one contact point: contact.png, the gap before anything gives way less what gave
# way, pressure.png and removal.png; three.png: removed after three points; whole.png: by the first path; errors.png and left.png: the error before
# and after; cell.png: part, wheel and robot. report.html holds the numbers.

B       ?= build
BELT    ?= $(B)/belt
DATA    ?=
EDGE    ?= $(DATA)/../before_after
PARTS   ?= blade
SPACING ?= 0.5
# What a ground part may have left, mm.
LOWER   ?= -0.02
UPPER   ?= 0.05
# N, mm/s
PRESS   ?= 10
FEED    ?= 6
# Its law is fitted to measured trials; WHEEL=samples/wheels/crowned_preston.json: Preston's.
WHEEL   ?= samples/wheels/crowned.json
# Distance of the points along a row, mm; limits of planned feeds.
STEP    ?= 1.25
# Distance of the rows, mm.
OVER    ?= 2
LIMITS_feed := --min 0.5 --max 200
PLANNED ?= yes
# What the first path leaves for the second, mm, which takes a tenth as much and so errs by less; its force, N; and a belt file for what the wheel has
# no room for, such as the handle's bore of 12 mm. Over most of the leading edge nothing is to be ground.
SPARE ?= 0.03
PRESS_AGAIN ?= 3
NARROW ?= samples/wheels/file.json
$(BELT)/edge/%: SPARE = 0
# At sharp edges a part of the wheel alone is on the metal: less force, so that the highest feed does not take too much, and closer rows.
$(BELT)/nasa/%: PRESS = 5
$(BELT)/nasa/%: STEP = 2
$(BELT)/nasa/%: OVER = 1.25
# The handle is large.
$(BELT)/handle/%: SPACING = 0.8
$(BELT)/handle/%: STEP = 2
$(BELT)/handle/%: OVER = 3

PICTURES := contact pressure removal three whole errors left cell
.PHONY: belt
belt: $(foreach part,$(PARTS),$(PICTURES:%=$(BELT)/$(part)/%.png) $(BELT)/$(part)/report.html)
	@pipelines/belt-table $(PARTS:%=$(BELT)/%)

# --- designs and their units: a blade in metres, a handle of the size of one ---------------------------------------------
$(BELT)/blade/design: pipelines/blade-design
	@mkdir -p $(@D)
	$< > $@
# Around its round end the sheets of NASA's blade lie in folds: its outlines are traced anew by a disc of the wheel's radius.
$(BELT)/nasa/design: $(DATA)/nasa_blade_a.stl pipelines/blade-sections $(B)/bin/fettle-clean
	@mkdir -p $(@D)
	$(B)/bin/fettle-clean $< --file-units m --units mm -q -o $(@D)/mesh.ply
	pipelines/blade-sections $(@D)/mesh.ply 20 > $@
# The handle is 1 unit long; so it becomes 100 mm.
$(BELT)/handle/design: $(DATA)/handle.off
	@mkdir -p $(@D)
	awk 'FNR > 2 && NF == 3 && !faces { print $$1 * 100, $$2 * 100, $$3 * 100; next } FNR > 2 && NF > 3 { faces = 1 } { print }' $< > $@
# The facets of the leading edge look inwards.
$(BELT)/edge/design: $(EDGE)/LE_mesh_grinded.ply $(B)/study/stock
	@mkdir -p $(@D)
	$(B)/study/stock $< --turned --min 0 --max 0 -o $@
$(BELT)/edge/stock.stl: $(EDGE)/LE_mesh.ply $(B)/study/stock
	@mkdir -p $(@D)
	$(B)/study/stock $< --turned --min 0 --max 0 -o $@

# --- the removal law from measured trials ----------------------------------------------------------------------------------
TRIALS ?= samples/removal
# Area of the contact, mm², and length of the belt in a revolution, mm, which is not published: of the fitted law it scales coefficient and wear_work.
AREA   ?= 50
TRAVEL ?= 100

.PHONY: law
law: $(BELT)/law/wheel.json $(BELT)/law/moving.json
	@pipelines/law-table $(BELT)/law

$(BELT)/law/%.json: $(TRIALS)/%.csv $(B)/study/belt-law
	@mkdir -p $(@D)
	$(B)/study/belt-law $< --area $(AREA) --travel $(TRAVEL) -o $@

$(BELT)/law/wheel.json: $(BELT)/law/static.json samples/wheels/rubber.json
	jq --slurpfile fit $< '.law = $$fit[0].law' samples/wheels/rubber.json > $@

# --- stages ---------------------------------------------------------------------------------------------------------------
$(BELT)/%/stock.stl: $(BELT)/%/design $(B)/study/stock
	$(B)/study/stock $< --min 0.2 --max 0.6 -o $@

$(BELT)/%/work.pcd: $(BELT)/%/design $(BELT)/%/stock.stl $(B)/bin/fettle-surfel
	$(B)/bin/fettle-surfel $< --stock $(@D)/stock.stl --spacing $(SPACING) --reach 2 -q --ascii --report $(@D)/work.json -o $@

# Exit status 1 of the judge is an answer, which the table shows.
ASSESS = $(B)/bin/fettle-assess $< --lower $(LOWER) --upper $(UPPER) -q
$(BELT)/%/errors.pcd: $(BELT)/%/work.pcd $(B)/bin/fettle-assess
	$(ASSESS) --report $(@D)/errors.json -o $@ || test $$? = 1
$(BELT)/%/surface.pcd: $(BELT)/%/work.pcd $(B)/bin/fettle-assess
	$(ASSESS) --displaced --report $(@D)/surface.json -o $@ || test $$? = 1
$(BELT)/%/left.pcd: $(BELT)/%/ground.pcd $(B)/bin/fettle-assess
	$(ASSESS) --report $(@D)/left.json --ascii -o $@ || test $$? = 1

# Rows where stock stands over the tolerance and the wheel has room.
ROWS = $(B)/bin/fettle-path $< --above $(UPPER) --ascii
$(BELT)/%/rows.pcd: $(BELT)/%/work.pcd $(WHEEL) $(B)/bin/fettle-path
	$(ROWS) --room-for $(WHEEL) --step-over $(OVER) --spacing $(STEP) --report $(@D)/rows.json -o $@

# Feeds that leave as much of the area as they can within the tolerance: the first path all of it higher by SPARE. PLANNED=no: the constant FEED.
# FEEDS(spare)
more = $(shell awk 'BEGIN { print $(1) + $(2) }')
FEEDS = $(B)/bin/fettle-feed $< $(LIMITS_feed) --rounds 6 --feed $(FEED) --wanted $(call more,$(MIDDLE),$(1)) --lower $(call more,$(LOWER),$(1)) --upper $(call more,$(UPPER),$(1)) --ascii -q
MIDDLE := $(shell awk 'BEGIN { print ($(LOWER) + $(UPPER)) / 2 }')
$(BELT)/%/planned.pcd: $(BELT)/%/rows.pcd $(BELT)/%/work.pcd $(WHEEL) $(B)/bin/fettle-feed
	$(if $(filter no,$(PLANNED)),cp $< $@,$(call FEEDS,$(SPARE)) --on $(@D)/work.pcd --wheel $(WHEEL) --force $(PRESS) --report $(@D)/plan.json -o $@)

GRIND = $(B)/bin/fettle-belt $< --wheel $(WHEEL) --force $(PRESS) --feed $(FEED)
# $< is to be ground, --wheel and --path follow.
GRIND_PLANNED = $(B)/bin/fettle-belt $< $(if $(filter no,$(PLANNED)),--force $(PRESS) --feed $(FEED)) --lower $(LOWER) --upper $(UPPER) --ascii
$(BELT)/%/once.pcd: $(BELT)/%/work.pcd $(BELT)/%/planned.pcd $(WHEEL) $(B)/bin/fettle-belt
	$(GRIND_PLANNED) --wheel $(WHEEL) --path $(@D)/planned.pcd --journal $(@D)/journal --watch $(@D)/once.csv --trace $(@D)/trace.pcd \
	    --report $(@D)/once.json -o $@
	rm -f $(@D)/journal

# Where what is left stands over the tolerance it is ground once more, by less force; then what the wheel has no room for, by a belt file. Not where
# nothing is, where no more is foreseen to be within (the path is empty then), nor with a constant feed.
$(BELT)/%/rest_rows.pcd: $(BELT)/%/once.pcd $(WHEEL) $(B)/bin/fettle-path
	$(ROWS) --room-for $(WHEEL) --step-over $(OVER) --spacing $(STEP) --report $(@D)/rest_rows.json -q -o $@ || test $$? = 1
$(BELT)/%/narrow_rows.pcd: $(BELT)/%/twice.pcd $(WHEEL) $(NARROW) $(B)/bin/fettle-path
	$(ROWS) --room-for $(NARROW) --no-room-for $(WHEEL) --step-over 1.2 --spacing 0.8 --report $(@D)/narrow_rows.json -q -o $@ || test $$? = 1
PLAN_AGAIN = if jq -e '.points > 1 and "$(PLANNED)" != "no"' $(@:.pcd=_rows.json) > /dev/null; then \
	    $(call FEEDS,0) --on $(word 2,$^) --force $(PRESS_AGAIN) --report $(@:.pcd=_plan.json) -o $@ && \
	    { jq -e '.within_planned > .within_before + 0.001' $(@:.pcd=_plan.json) > /dev/null || : > $@; }; else : > $@; fi
$(BELT)/%/rest.pcd: $(BELT)/%/rest_rows.pcd $(BELT)/%/once.pcd $(B)/bin/fettle-feed
	$(subst --force,--wheel $(WHEEL) --force,$(PLAN_AGAIN))
$(BELT)/%/narrow.pcd: $(BELT)/%/narrow_rows.pcd $(BELT)/%/twice.pcd $(B)/bin/fettle-feed
	$(subst --force,--wheel $(NARROW) --force,$(PLAN_AGAIN))
# GRIND_AGAIN(path, wheel)
GRIND_AGAIN = rm -f $(@D)/$(1).csv $(@D)/$(1).json; if [ -s $(@D)/$(1).pcd ]; then $(GRIND_PLANNED) --wheel $(2) --path $(@D)/$(1).pcd --watch $(@D)/$(1).csv --report $(@D)/$(1).json -o $@; else cp $< $@; fi
$(BELT)/%/twice.pcd: $(BELT)/%/once.pcd $(BELT)/%/rest.pcd $(B)/bin/fettle-belt
	$(call GRIND_AGAIN,rest,$(WHEEL))
$(BELT)/%/ground.pcd: $(BELT)/%/twice.pcd $(BELT)/%/narrow.pcd $(B)/bin/fettle-belt
	$(call GRIND_AGAIN,narrow,$(NARROW))
	awk -F, -v OFS=, 'FNR == 1 && NR > 1 { end = last; next } FNR > 1 { $$2 += end; last = $$2 } { print }' $$(for path in once rest narrow; do ls $(@D)/$$path.csv 2> /dev/null; done) > $(@D)/watch.csv

APART = $(shell awk 'BEGIN { print int(8 / $(STEP) + 0.5) }')
# --- one contact point, three, and the whole path --------------------------------------------------------------------------
$(BELT)/%/one.pcd: $(BELT)/%/rows.pcd pipelines/belt-points
	pipelines/belt-points middle 1 0 < $< > $@
$(BELT)/%/three.pcd: $(BELT)/%/rows.pcd pipelines/belt-points
	pipelines/belt-points middle 3 $(APART) < $< > $@
$(BELT)/%/contact.pcd: $(BELT)/%/work.pcd $(BELT)/%/one.pcd $(WHEEL) $(B)/bin/fettle-contact
	$(B)/bin/fettle-contact $< --wheel $(WHEEL) --at "$$(pipelines/belt-points pose < $(@D)/one.pcd)" --force $(PRESS) --report $(@D)/contact.json -o $@
# Half a second there; the three points take the time of the ways between them, 8 mm each.
$(BELT)/%/at-one.pcd: $(BELT)/%/work.pcd $(BELT)/%/one.pcd $(WHEEL) $(B)/bin/fettle-belt
	$(GRIND) --path $(@D)/one.pcd --dwell 0.5 --ascii | pipelines/belt-points near "$$(pipelines/belt-points pose < $(@D)/one.pcd)" 12 > $@
$(BELT)/%/at-three.pcd: $(BELT)/%/work.pcd $(BELT)/%/three.pcd $(WHEEL) $(B)/bin/fettle-belt
	$(GRIND) --path $(@D)/three.pcd --ascii | pipelines/belt-points near "$$(pipelines/belt-points pose < $(@D)/three.pcd)" 22 > $@

# --- pictures ---------------------------------------------------------------------------------------------------------------
ALONG = --from "$$(pipelines/belt-points normal < $(@D)/one.pcd)"
RENDER = $(B)/bin/fettle-render $< -o $@
# The finding, for a headline.
WITHIN = jq -r '"\(1000 * .within | round / 10) % within the tolerance"'
$(BELT)/%/contact.png: $(BELT)/%/contact.pcd $(B)/bin/fettle-render
	$(RENDER) --field gap $(ALONG) --title '$*: gap beside the contact'
$(BELT)/%/pressure.png: $(BELT)/%/contact.pcd $(B)/bin/fettle-render
	$(RENDER) --field pressure $(ALONG) --title '$*: pressure, MPa'
$(BELT)/%/removal.png: $(BELT)/%/at-one.pcd $(B)/bin/fettle-render
	$(RENDER) --field removed $(ALONG) --title '$*: removed at one contact point'
$(BELT)/%/three.png: $(BELT)/%/at-three.pcd $(BELT)/%/one.pcd $(B)/bin/fettle-render
	$(RENDER) --field removed $(ALONG) --title '$*: removed after three points'
$(BELT)/%/whole.png: $(BELT)/%/once.pcd $(B)/bin/fettle-render
	$(RENDER) --field removed --scale 0.8 --from 1,-2,0.5 --title '$*: removed by the first path'
$(BELT)/%/errors.png: $(BELT)/%/errors.pcd $(B)/bin/fettle-render
	$(RENDER) --scale 0.6 --from 1,-2,0.5 --title "$*: before grinding $$($(WITHIN) $(@D)/errors.json)"
$(BELT)/%/left.png: $(BELT)/%/left.pcd $(BELT)/%/remains.txt $(B)/bin/fettle-render
	$(RENDER) --scale 0.6 --from 1,-2,0.5 --title "$*: after grinding $$(awk '$$1 == "all:" { print 100 * $$2 }' $(@D)/remains.txt) % of the area within the tolerance"

# The robot holds the wheel; the part is before it so that the contact point is at SPOT with the wheel above it.
SPOT = 1000,950,520
WHEEL_FOR_BALL = $$wheel[0] as $$w | .bodies |= map(select(.name | IN("ball", "shank", "holder", "vise") | not)) + \
    [{name: "wheel", link: 7, shape: "cylinder", from: [0, -$$w.width / 2, $$w.radius], to: [0, $$w.width / 2, $$w.radius], radius: $$w.radius}]
$(BELT)/cell.json: samples/robots/irb1400_vise.json $(WHEEL)
	jq --slurpfile wheel $(WHEEL) '$(WHEEL_FOR_BALL)' $< > $@
$(BELT)/%/placed.stl: $(BELT)/%/design $(BELT)/%/one.pcd $(B)/study/stock
	$(B)/study/stock $< --min 0.4 --max 0.4 --at "$$(pipelines/belt-points under $(SPOT) < $(@D)/one.pcd)" -o $@
$(BELT)/spot.pcd:
	printf '# units mm\nVERSION 0.7\nFIELDS x y z qw qx qy qz\nSIZE 4 4 4 4 4 4 4\nTYPE F F F F F F F\nCOUNT 1 1 1 1 1 1 1\nWIDTH 1\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 1\nDATA ascii\n%s 1 0 0 0\n' "$$(echo $(SPOT) | tr , ' ')" > $@
# Exit status 1 says that the rigid wheel of the picture is in the part by more than the tolerance, as on a nose beside the contact point.
$(BELT)/%/cell.png: $(BELT)/%/placed.stl $(BELT)/cell.json $(BELT)/spot.pcd $(B)/bin/fettle-collide
	$(B)/bin/fettle-collide $(BELT)/cell.json $(BELT)/spot.pcd --workpiece $< --tolerance 1 --picture $@ --report $(@D)/cell.json -q -o /dev/null || test $$? = 1

$(BELT)/%/remains.txt: $(BELT)/%/work.pcd $(BELT)/%/left.pcd pipelines/belt-remains
	pipelines/belt-remains $(@D) > $@

$(BELT)/%/report.html: $(BELT)/%/remains.txt $(BELT)/%/errors.pcd $(BELT)/%/surface.pcd $(WHEEL) pipelines/belt-page
	pipelines/belt-page $(@D) $(WHEEL) > $@

# --- the robot holds the part: a belt over a wheel on a stand, whose contact point is at AT with the part above it ---------------
# BELT/held: path.pcd are the strokes joined off the part, as the tool's poses in the cell; checked.pcd their joints and clearances: of the
# part's own triangles and of the arm from wheel, belt and stand. cell.png shows a contact point of
# the first, a middle and the last stroke, with the wheel where it is.
AT      ?= 900,1000,900,0,0,1,0
# The rigid wheel of the check stands for an elastic one that gives way, mm.
PRESSED ?= 0.5
HELD    := $(BELT)/held

.PHONY: held
held: $(HELD)/checked.pcd
	@jq -r '"\(.reached) of \(.count) poses reached, \(.jumps | length) jumps; \(.collisions) collide, \(.collisions_between) ways between them; least clearance \(1000 * .min.clearance | round / 1000) mm, \(.min.pair | join(" and "))"' $(HELD)/report.json
	@jq -e '.collisions + .collisions_between + (.count - .reached) + (.jumps | length) == 0' $(HELD)/report.json > /dev/null

$(HELD)/part.stl: $(BELT)/blade/design $(B)/study/stock
	@mkdir -p $(@D)
	$(B)/study/stock $< --min 0 --max 0 -o $@
$(HELD)/path.pcd: $(BELT)/blade/work.pcd $(B)/bin/fettle-path
	@mkdir -p $(@D)
	$(B)/bin/fettle-path $< --step-over 4 --spacing 0.2 --clearance 20 --held part --wheel $(AT) --ascii -o $@
# Around the leading edge the part turns by 90 degrees nearly on the spot.
$(HELD)/checked.pcd: $(HELD)/path.pcd $(HELD)/part.stl samples/robots/irb1400_belt.json pipelines/belt-points $(B)/bin/fettle-collide
	$(B)/bin/fettle-collide samples/robots/irb1400_belt.json $< --workpiece $(HELD)/part.stl --held --tolerance $(PRESSED) --jump 90 -q \
	    --report $(HELD)/report.json --picture $(HELD)/cell.png --from 1,-0.6,0.5 --at "$$(pipelines/belt-points contacts < $<)" -o $@ || test $$? = 1

# --- plans for the blade: feeds of each contact point, or forces, beside the best constant -------------------------------------
# Its flat trailing edge is not ground with its sides. Planned on surfels SPACING apart; ground, to be judged, on others that are
# closer together. BELT/plan/VARY/report.json is the plan's account, constant/ and planned/ have what is left.
VARY  ?= feed force
FINER ?= $(shell awk 'BEGIN { print 0.7 * $(SPACING) }')
LIMITS_force := --min 1 --max 40
OTHER_feed   := --force $(PRESS)
OTHER_force  := --feed $(FEED)
PLAN := $(BELT)/plan

.PHONY: plan
plan: $(foreach vary,$(VARY),$(foreach how,constant planned,$(PLAN)/$(vary)/$(how)/errors.png))
	@pipelines/plan-table $(VARY:%=$(PLAN)/%)

$(PLAN)/design: $(BELT)/blade/design
	@mkdir -p $(@D)
	jq '.patches |= .[:1]' $< > $@

$(PLAN)/work.pcd $(PLAN)/finer.pcd: $(PLAN)/%.pcd: $(PLAN)/design $(BELT)/blade/stock.stl $(B)/bin/fettle-surfel
	$(B)/bin/fettle-surfel $< --stock $(BELT)/blade/stock.stl --spacing $(if $(filter work,$*),$(SPACING),$(FINER)) --reach 2 -q -o $@

$(PLAN)/rows.pcd: $(PLAN)/work.pcd $(B)/bin/fettle-path
	$(B)/bin/fettle-path $< --step-over 2 --spacing $(STEP) -o $@

$(PLAN)/%/planned.pcd: $(PLAN)/rows.pcd $(PLAN)/work.pcd $(WHEEL) $(B)/bin/fettle-feed
	@mkdir -p $(@D)
	$(B)/bin/fettle-feed $< --on $(PLAN)/work.pcd --wheel $(WHEEL) --vary $* $(LIMITS_$*) --force $(PRESS) --feed $(FEED) -q --report $(@D)/report.json -o $@

# The constant that the plan found best.
$(PLAN)/%/constant/ground.pcd: $(PLAN)/%/planned.pcd $(PLAN)/finer.pcd $(B)/bin/fettle-belt
	@mkdir -p $(@D)
	$(B)/bin/fettle-belt $(PLAN)/finer.pcd --path $(PLAN)/rows.pcd --wheel $(WHEEL) $(OTHER_$*) \
	    --$* "$$(jq .constant $(PLAN)/$*/report.json)" -q -o $@
$(PLAN)/%/planned/ground.pcd: $(PLAN)/%/planned.pcd $(PLAN)/finer.pcd $(B)/bin/fettle-belt
	@mkdir -p $(@D)
	$(B)/bin/fettle-belt $(PLAN)/finer.pcd --path $< --wheel $(WHEEL) -q -o $@

$(PLAN)/%/errors.pcd: $(PLAN)/%/ground.pcd $(B)/bin/fettle-assess
	$(B)/bin/fettle-assess $< --lower $(LOWER) --upper $(UPPER) -q --report $(@D)/errors.json -o $@ || test $$? = 1

$(PLAN)/%/errors.png: $(PLAN)/%/errors.pcd $(B)/bin/fettle-render
	$(B)/bin/fettle-render $< --scale 0.2 --from 1,-2,0.5 --title "$*: $$($(WITHIN) $(@D)/errors.json)" -o $@

.DELETE_ON_ERROR:
.SECONDARY:
