# Belt grinding: a rough part as surfels, what is left on it, and a path over it.
#
#   make -f pipelines/belt.mk                                      the blade that the project makes itself
#   make -f pipelines/belt.mk PARTS='blade nasa handle' DATA=DIR   and DIR/nasa_blade_a.stl and DIR/handle.off
#   make -f pipelines/belt.mk plan                                 feeds, and forces, that meet the blade's allowance
#   make -f pipelines/belt.mk law                                  the removal law from measured trials; exit 1 if a figure is missed
#
# BELT/PART/stock.stl is the design with an allowance of 0.2 to 0.6 mm that varies over it, work.pcd the surfels, errors.pcd what
# would be left without grinding, surface.pcd the stock's surface with its normals, rows.pcd a path; errors.png the picture.

B       ?= build
BELT    ?= $(B)/belt
DATA    ?=
PARTS   ?= blade
SPACING ?= 0.5
# What a ground part may have left, mm.
LOWER   ?= -0.02
UPPER   ?= 0.05

.PHONY: belt
belt: $(foreach part,$(PARTS),$(BELT)/$(part)/errors.png $(BELT)/$(part)/rows.json $(BELT)/$(part)/errors.json)
	@pipelines/belt-table $(PARTS:%=$(BELT)/%)

# --- designs and their units: a blade in metres, a handle of the size of one ---------------------------------------------
$(BELT)/blade/design: pipelines/blade-design
	@mkdir -p $(@D)
	$< > $@
$(BELT)/nasa/design: $(DATA)/nasa_blade_a.stl
	@mkdir -p $(@D)
	cp $< $@
# The handle is 1 unit long; so it becomes 100 mm.
$(BELT)/handle/design: $(DATA)/handle.off
	@mkdir -p $(@D)
	awk 'FNR > 2 && NF == 3 && !faces { print $$1 * 100, $$2 * 100, $$3 * 100; next } FNR > 2 && NF > 3 { faces = 1 } { print }' $< > $@
$(BELT)/nasa/%: UNITS = --file-units m

# --- the removal law from measured trials ----------------------------------------------------------------------------------
TRIALS ?= samples/removal
# Of the contact, mm², and of the belt in a revolution, mm, which is not published: of the fitted law it scales coefficient and wear_work.
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
	$(B)/study/stock $< $(UNITS) --least 0.2 --most 0.6 -o $@

$(BELT)/%/work.pcd: $(BELT)/%/design $(BELT)/%/stock.stl $(B)/bin/fettle-surfel
	$(B)/bin/fettle-surfel $< $(UNITS) --stock $(@D)/stock.stl --spacing $(SPACING) --reach 2 -q --report $(@D)/work.json -o $@

# Exit status 1 of the judge is an answer, which the table tells.
$(BELT)/%/errors.pcd: $(BELT)/%/work.pcd $(B)/bin/fettle-assess
	$(B)/bin/fettle-assess $< --lower $(LOWER) --upper $(UPPER) -q --report $(@D)/errors.json -o $@ || test $$? = 1
	$(B)/bin/fettle-assess $< --lower $(LOWER) --upper $(UPPER) -q --displaced --report $(@D)/surface.json -o $(@D)/surface.pcd || test $$? = 1
$(BELT)/%/errors.json: $(BELT)/%/errors.pcd ;

$(BELT)/%/rows.pcd: $(BELT)/%/work.pcd $(B)/bin/fettle-path
	$(B)/bin/fettle-path $< --step-over 2 --spacing 0.5 --report $(@D)/rows.json -o $@
$(BELT)/%/rows.json: $(BELT)/%/rows.pcd ;

$(BELT)/%/errors.png: $(BELT)/%/errors.pcd $(B)/bin/fettle-render
	$(B)/bin/fettle-render $< --scale 0.6 --from 1,-2,0.5 --title '$*: allowance before grinding' -o $@

# --- plans for the blade: feeds of each contact point, or forces, beside the best constant -------------------------------------
# Its flat trailing edge is not ground with its sides. Planned on surfels SPACING apart; ground, to be judged, on others that are
# closer together. BELT/plan/VARY/report.json is the plan's account, constant/ and planned/ have what is left.
VARY  ?= feed force
PRESS ?= 10
WHEEL ?= samples/wheels/crowned.json
FINER ?= $(shell awk 'BEGIN { print 0.7 * $(SPACING) }')
FEED  ?= 6
LIMITS_feed  := --least 0.5 --most 200
LIMITS_force := --least 1 --most 40
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
	$(B)/bin/fettle-path $< --step-over 2 --spacing 2 -o $@

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
	$(B)/bin/fettle-render $< --scale 0.2 --from 1,-2,0.5 --title '$*: what is left' -o $@

.DELETE_ON_ERROR:
.SECONDARY:
