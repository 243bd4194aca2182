# The layer-based strategy (Wang 2007, 5.3) against a prism of virtual stock (5.1), and its three cases of overlapping layers
# (5.3.1), in stock that yields as the job says and a tenth as fast. Constants: samples/studies/strategy.json.
#
#   make -f pipelines/strategy.mk -j2             two tables, each also as CSV; figure 5-8 as pictures; exit 1 if a figure is missed
#   make -f pipelines/strategy.mk PARTS=hill FACTORS=1 SHOWN=
#
# STRATEGY/PART/FACTOR/WAY.json is the report of one run, WAY.pcd its trace. WAY: case1 to case3, the strategy with F_down
# above, below and at the mean of F_min and F_max; `prism`, as high as the metal is; `tall`, as high as the metal may be; `blind`, the
# same planned for the job's stock.

B        ?= build
CONSTANT := samples/studies/strategy.json
PARTS    ?= $(shell jq -r '.parts | join(" ")' $(CONSTANT))
FACTORS  ?= $(shell jq -r '.removal_factors | join(" ")' $(CONSTANT))
# Drawn in the stock of the job, of the parts that are ground in it.
SHOWN    ?= $(if $(filter 1,$(FACTORS)),$(filter $(PARTS),$(shell jq -r '.shown | join(" ")' $(CONSTANT))))
HEIGHT   := $(shell jq .prism_height $(CONSTANT))
STRATEGY ?= $(B)/strategy
CASES    := case1 case2 case3
PRISMS   := prism tall blind
WAYS     := $(CASES) $(PRISMS)
JOB       = samples/jobs/$(1).json

.PHONY: strategy
strategy: $(foreach p,$(PARTS),$(foreach f,$(FACTORS),$(foreach w,$(WAYS),$(STRATEGY)/$(p)/$(f)/$(w).json))) $(SHOWN:%=$(STRATEGY)/%.png)
	@pipelines/strategy-table $(STRATEGY) "$(PARTS)" "$(FACTORS)"
	@$(if $(SHOWN),echo "pictures: $(SHOWN:%=$(STRATEGY)/%.png)")

include pipelines/step.mk

$(STRATEGY)/%/stock.stl: $(B)/bin/fettle-part samples/parts/%.json
	$(call step,$< samples/parts/$*.json > $@.part)

$(STRATEGY)/%/desired.json: $(STRATEGY)/%/stock.stl $(addprefix $(B)/bin/fettle-,sample fit)
	$(call step,$(B)/bin/fettle-sample $(call JOB,$*) --on $< --strategy wang | $(B)/bin/fettle-fit $(call JOB,$*) > $@.part)

define plan_rule
$(STRATEGY)/%/$(1).plan.json: $(STRATEGY)/%/desired.json $(CONSTANT) $(B)/bin/fettle-plan
	$$(call step,jq --slurpfile all $(CONSTANT) ".force.down = \$$$$all[0].force_down.$(1)" $$(call JOB,$$*) > $$@.job && $(B)/bin/fettle-plan $$@.job $$< > $$@.part)
endef
$(foreach c,$(CASES),$(eval $(call plan_rule,$(c))))

define run_rules
$(STRATEGY)/$(1)/$(2)/case%.json: $(STRATEGY)/$(1)/case%.plan.json $(STRATEGY)/$(1)/stock.stl $(B)/bin/fettle-grind
	$$(call step,$(B)/bin/fettle-grind $$< --stock $(STRATEGY)/$(1)/stock.stl --gantry virtual --removal-factor $(2) -q --ascii --trace $$(@:.json=.pcd) --report $$@.part > $$@.ground && rm $$@.ground)

$(STRATEGY)/$(1)/$(2)/%.json: $(STRATEGY)/$(1)/case3.plan.json $(STRATEGY)/$(1)/stock.stl $(B)/study/prism
	$$(call step,$(B)/study/prism $$< --stock $(STRATEGY)/$(1)/stock.stl --removal-factor $(2) $$(if $$(filter prism,$$*),,--height $(HEIGHT)) $$(if $$(filter blind,$$*),,--planned-factor $(2)) --trace $$(@:.json=.pcd) > $$@.part)
endef
$(foreach p,$(PARTS),$(foreach f,$(FACTORS),$(eval $(call run_rules,$(p),$(f)))))

# Figure 5-8, in the stock of the job.
$(STRATEGY)/%.png: $(STRATEGY)/%/1/case3.json $(STRATEGY)/%/case3.plan.json $(B)/study/strategy-chart
	$(call step,$(B)/study/strategy-chart $(STRATEGY)/$*/case3.plan.json --stock $(STRATEGY)/$*/stock.stl --trace $(<:.json=.pcd) --title $* > $@.part)
