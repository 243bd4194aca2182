# Proper F_min and F_max for each wheel and metal (Wang 2007, 7.2): one part, ground with every pair of forces on the full-scale
# machine. Constants: samples/studies/forces.json (lengths and forces in the job's units, the spindle in W and kg m², specific energy in J/mm³).
#
#   make -f pipelines/forces.mk -j2                                 the table, all runs as runs.csv; exit 1 if a wheel has no range
#   make -f pipelines/forces.mk WHEELS=thin METALS=grey_iron        one of each
#
# A wheel of rim speed v that takes the tangential force of μ F needs u for each volume (the metal's specific energy): it removes
# c F with c = μ v / u. FORCES/WHEEL/METAL/F_MAX/SHARE.json is the report of one run, SHARE that of F_min in F_max.

B        ?= build
CONSTANT := samples/studies/forces.json
constant  = $(shell jq -r '$(1)' $(CONSTANT))
WHEELS   ?= $(call constant,.wheels | keys_unsorted | join(" "))
METALS   ?= $(call constant,.specific_energy | keys_unsorted | join(" "))
MAX_FORCES     ?= $(call constant,.force_max | join(" "))
SHARES   ?= $(call constant,.force_min_share | join(" "))
PART     := $(call constant,.part)
MACHINE  := samples/machines/$(call constant,.machine).json
FORCES   ?= $(B)/forces
JOB      := samples/jobs/$(PART).json

.PHONY: forces
forces: $(foreach w,$(WHEELS),$(foreach m,$(METALS),$(foreach f,$(MAX_FORCES),$(foreach s,$(SHARES),$(FORCES)/$(w)/$(m)/$(f)/$(s).json))))
	@pipelines/forces-table $(FORCES) $(CONSTANT) "$(WHEELS)" "$(METALS)" "$(MAX_FORCES)" "$(SHARES)"

include pipelines/step.mk

$(FORCES)/stock.stl: $(B)/bin/fettle-part samples/parts/$(PART).json
	$(call step,$< samples/parts/$(PART).json > $@.part)

$(FORCES)/desired.json: $(FORCES)/stock.stl $(addprefix $(B)/bin/fettle-,sample fit)
	$(call step,$(B)/bin/fettle-sample $(JOB) --on $< --strategy wang | $(B)/bin/fettle-fit $(JOB) > $@.part)

$(FORCES)/%/machine.json: $(MACHINE) $(CONSTANT)
	$(call step,jq --slurpfile all $(CONSTANT) -f pipelines/jq/forces_machine.jq --arg wheel $* $< > $@.part)

# The table reports a run that does not finish.
define wheel_rules
$(FORCES)/$(1)/%.job: $(JOB) $(MACHINE) $(CONSTANT) pipelines/jq/forces_job.jq
	$$(call step,jq --slurpfile all $(CONSTANT) --slurpfile machine $(MACHINE) -f pipelines/jq/forces_job.jq --arg cell $(1)/$$* $$< > $$@.part)

$(FORCES)/$(1)/%.json: $(FORCES)/$(1)/%.job $(FORCES)/$(1)/machine.json $(FORCES)/desired.json $(addprefix $(B)/bin/fettle-,plan grind)
	$$(call step,$(B)/bin/fettle-plan $$< $(FORCES)/desired.json > $$@.plan && $(B)/bin/fettle-grind $$@.plan --stock $(FORCES)/stock.stl \
	    --gantry virtual:dynamic --machine $(FORCES)/$(1)/machine.json -q --report $$@.part -o $$@.ground.pcd || test $$$$? = 1; rm -f $$@.ground.pcd $$@.plan)
endef
$(foreach w,$(WHEELS),$(eval $(call wheel_rules,$(w))))
