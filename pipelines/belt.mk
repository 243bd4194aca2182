# Belt grinding: a rough part as surfels, what is left on it, and a path over it.
#
#   make -f pipelines/belt.mk                                      the blade that the project makes itself
#   make -f pipelines/belt.mk PARTS='blade nasa handle' DATA=DIR   and DIR/nasa_blade_a.stl and DIR/handle.off
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

.DELETE_ON_ERROR:
.SECONDARY:
