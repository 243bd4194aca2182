# How layer 1 is ground: at the job's feed, by feed-rate control or by force control (Wang 2007, 6.1.4.2). Wang's three parts on the full-scale
# machine, in stock that yields half, once and one and a half times as fast as the job says.
#
#   make -f pipelines/layer1.mk -j2                      the table; exit 1 if a figure is missed
#   make -f pipelines/layer1.mk PARTS=2 FACTORS=1        one part in one stock
#
# LAYER1/PART/FACTOR/CONTROL.json is the report of one run, CONTROL.left.json what it left over the desired surface.

B       ?= build
PARTS   ?= 1 2 3
FACTORS ?= 0.5 1 1.5
LAYER1  ?= $(B)/layer1
CONTROLS := constant feed force
JOB      = samples/jobs/wang$(1).json

.PHONY: layer1
layer1: $(foreach p,$(PARTS),$(foreach f,$(FACTORS),$(foreach c,$(CONTROLS),$(LAYER1)/$(p)/$(f)/$(c).left.json)))
	@pipelines/layer1-table $(LAYER1) "$(PARTS)" "$(FACTORS)"

include pipelines/step.mk

$(LAYER1)/%/stock.stl: $(B)/bin/fettle-part samples/parts/wang%.json
	$(call step,$< samples/parts/wang$*.json > $@.part)

$(LAYER1)/%/desired.json: $(LAYER1)/%/stock.stl $(addprefix $(B)/bin/fettle-,sample fit)
	$(call step,$(B)/bin/fettle-sample $(call JOB,$*) --on $< --strategy wang | $(B)/bin/fettle-fit $(call JOB,$*) > $@.part)

$(LAYER1)/%/plan.json: $(LAYER1)/%/desired.json $(B)/bin/fettle-plan
	$(call step,$(B)/bin/fettle-plan $(call JOB,$*) $< > $@.part)

$(LAYER1)/%/desired.stl: $(LAYER1)/%/desired.json $(B)/bin/fettle-mesh
	$(call step,$(B)/bin/fettle-mesh $< --step 0.02 --within $(call JOB,$*) --stl > $@.part)

# The table reports a run that does not finish.
define cell_rule
$(LAYER1)/$(1)/$(2)/$(3).json: $(LAYER1)/$(1)/plan.json $(LAYER1)/$(1)/stock.stl $(B)/bin/fettle-grind
	$$(call step,$(B)/bin/fettle-grind $$< --stock $(LAYER1)/$(1)/stock.stl --gantry virtual:dynamic \
	    --machine samples/machines/full_scale.json --removal-factor $(2) --layer-1 $(3) --report $$@.part -q \
	    > $$(@:.json=.pcd) || test $$$$? = 1)

$(LAYER1)/$(1)/$(2)/$(3).left.json: $(LAYER1)/$(1)/$(2)/$(3).json $(LAYER1)/$(1)/desired.stl $(B)/bin/fettle-compare
	$$(call step,$(B)/bin/fettle-compare $$(<:.json=.pcd) --to $(LAYER1)/$(1)/desired.stl --mode z \
	    --within $(call JOB,$(1)) --report $$@.part -q > $$@.map; rm -f $$@.map)
endef
$(foreach p,$(PARTS),$(foreach f,$(FACTORS),$(foreach c,$(CONTROLS),$(eval $(call cell_rule,$(p),$(f),$(c))))))
