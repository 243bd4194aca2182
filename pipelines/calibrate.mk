# Removal laws that are learnt: how well the next pass is predicted, how honestly, and whether a hidden law is found.
#
#   make -f pipelines/calibrate.mk -j2                     the table; exit 1 if a figure is missed
#   make -f pipelines/calibrate.mk -j2 SERIES=20 RUNS=2    fewer series of each hidden law, fewer noisy runs of part 1
#
# CALIBRATE/LAW.csv has a line a series drawn from a hidden law (pipelines/programs/law-series.cc); static.json and moving.json are the reports on the
# measured rows; part1/N.json those of Wang's part 1, ground on a gantry that removes HIDDEN of what its job says, from the first covering of
# its trace, with forces 5 % and heights 0.02 mm (a standard deviation each) off. like/PART-LAYER1.csv has PARTS like parts of Wang's, one after the other,
# whose coefficient falls by 30 %, ground with fettle-grind --learn and without. edge.json compares the free sides of a wheel by its layer and by finite elements;
# exponents.csv has the exponents that fettle-belt --learn finds, halving.txt what half the spacing changes, speed.txt the seconds that 10,000 contacts
# on a million surfels take, which mean something on a quiet machine of two cores. BELT= leaves these out.

B         ?= build
SERIES    ?= 200
RUNS      ?= 20
SEED      ?= 1
HIDDEN    ?= 0.7
PARTS     ?= 10
LIKE      ?= 1-force 2-force 1-constant
CALIBRATE ?= $(B)/calibrate/$(SERIES)-$(RUNS)/$(SEED)
TRIALS    ?= samples/removal
BELT      ?= exponents.csv halving.txt speed.txt
LAWS      := preston power tails threshold wearing
PART      := $(CALIBRATE)/part1

.PHONY: calibrate
calibrate: $(LAWS:%=$(CALIBRATE)/%.csv) $(CALIBRATE)/static.json $(CALIBRATE)/moving.json $(patsubst %,$(PART)/%.json,$(shell seq $(RUNS))) \
           $(LIKE:%=$(CALIBRATE)/like-$(PARTS)/%.csv) $(CALIBRATE)/edge.json $(BELT:%=$(CALIBRATE)/%)
	@SERIES=$(SERIES) RUNS=$(RUNS) HIDDEN=$(HIDDEN) PARTS=$(PARTS) pipelines/calibrate-table $(CALIBRATE) "$(LAWS)" "$(LIKE)"

include pipelines/step.mk

$(CALIBRATE)/edge.json: pipelines/calibrate-edge samples/wheels/crowned.json $(B)/bin/fettle-contact
	$(call step,$< $(B)/bin > $@.part)

$(CALIBRATE)/exponents.csv: pipelines/calibrate-exponents samples/wheels/crowned.json $(B)/bin/fettle-belt
	$(call step,$< $(B)/bin > $@.part)

# The case of the suite prints a line a bead, up to the first that fails.
$(CALIBRATE)/halving.txt: tests/fettle-belt/halving.sh $(B)/bin/fettle-belt
	@mkdir -p $(@D)/halving
	$(call step,(cd $(@D)/halving && PATH="$(abspath $(B)/bin):$$PATH" SAMPLES="$(abspath samples)" bash -e $(abspath $<)) > $@.part || true)

$(CALIBRATE)/speed.txt: pipelines/calibrate-speed samples/wheels/crowned_preston.json $(B)/bin/fettle-clean $(B)/bin/fettle-belt
	$(call step,$< $(B)/bin > $@.part)

$(LAWS:%=$(CALIBRATE)/%.csv): $(CALIBRATE)/%.csv: $(B)/study/law-series
	$(call step,$< $* $(SERIES) $(SEED) > $@.part)

$(CALIBRATE)/static.json $(CALIBRATE)/moving.json: $(CALIBRATE)/%.json: $(TRIALS)/%.csv $(B)/bin/fettle-calibrate
	@mkdir -p $(@D)
	$(B)/bin/fettle-calibrate $< -q --report $@ -o $(@D)/$*-law.json

JOB := samples/jobs/wang1.json
$(PART)/stock.stl: samples/parts/wang1.json $(B)/bin/fettle-part
	@mkdir -p $(@D)
	$(B)/bin/fettle-part $< -o $@
$(PART)/plan.json: $(PART)/stock.stl $(JOB) $(B)/bin/fettle-sample $(B)/bin/fettle-fit $(B)/bin/fettle-plan
	$(B)/bin/fettle-sample $(JOB) --on $< -q | $(B)/bin/fettle-fit $(JOB) -q | $(B)/bin/fettle-plan $(JOB) -q -o $@
$(PART)/trace.pcd: $(PART)/plan.json $(PART)/stock.stl $(B)/bin/fettle-grind
	$(B)/bin/fettle-grind $< --stock $(PART)/stock.stl --gantry virtual --removal-factor $(HIDDEN) --ascii -q --trace $@ -o $(PART)/ground.pcd

SAMPLE_TOOLS := $(addprefix $(B)/bin/fettle-,part sample fit plan mesh)
define like_rule
$(CALIBRATE)/like-$(PARTS)/$(1).csv: pipelines/calibrate-parts $(CALIBRATE)/like/$(firstword $(subst -, ,$(1)))/desired.stl $(B)/bin/fettle-grind $(B)/bin/fettle-compare
	$$(call step,$$< $(B)/bin $$(dir $$(word 2,$$^))plan.json $$(dir $$(word 2,$$^))stock.stl $$(word 2,$$^) \
	    samples/jobs/wang$(firstword $(subst -, ,$(1))).json $(lastword $(subst -, ,$(1))) $(PARTS) > $$@.part)
endef
$(foreach like,$(LIKE),$(eval $(call like_rule,$(like))))

$(CALIBRATE)/like/%/desired.stl: samples/parts/wang%.json samples/jobs/wang%.json $(SAMPLE_TOOLS)
	@mkdir -p $(@D)
	$(B)/bin/fettle-part $< -o $(@D)/stock.stl
	$(B)/bin/fettle-sample $(word 2,$^) --on $(@D)/stock.stl --strategy wang -q | $(B)/bin/fettle-fit $(word 2,$^) -q -o $(@D)/desired.json
	$(B)/bin/fettle-plan $(word 2,$^) $(@D)/desired.json -q -o $(@D)/plan.json
	$(B)/bin/fettle-mesh $(@D)/desired.json --step 0.02 --within $(word 2,$^) --stl -o $@

$(PART)/%.json: $(PART)/trace.pcd $(PART)/stock.stl pipelines/calibrate-noise $(B)/bin/fettle-calibrate $(B)/bin/fettle-part
	pipelines/calibrate-noise $* < $< > $(PART)/$*.pcd
	jq '.noise = "normal:0.00203"' samples/parts/wang1.json | $(B)/bin/fettle-part - --seed $* -o $(PART)/$*.stl
	$(B)/bin/fettle-calibrate $(PART)/$*.pcd --job $(JOB) --before $(PART)/$*.stl -q --report $@ -o $(PART)/$*-law.json
