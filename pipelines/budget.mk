# The nine sources of error that Wang names (2007, 6.2), one at a time and together: his verification from the printed pattern to the
# map of differences, on his three parts. Constants: samples/studies/budget.json.
#
#   make -f pipelines/budget.mk -j2                                         the table, also as budget.csv; exit 1 if a figure is missed
#   make -f pipelines/budget.mk PARTS=wang1 SETS='none all' DRAWS=1         some of it
#
# BUDGET/PART/SET/DRAW/errors.json is one comparison. SET: none, all, or one of
#   printing       1  pattern and comparison part, each warped          casting    2  the epoxy part, warped and shrunk
#   scanner        3  noise of the ground part's and the comparison part's scan
#   registration   4  the ground part's scan, shifted and turned        following  5  drives, screws and head of the prototype
#   lvdt           6  resolution, noise and zero of its transducer      touches    7  noise of the sampled points
#   approximation  8  Wang's surface for the part, not the part's own family
#   tool           9  the wheel's width, and its wear between touch-offs

B        ?= build
CONSTANT := samples/studies/budget.json
constant  = $(shell jq -r '$(1)' $(CONSTANT))
PARTS    ?= $(call constant,.parts | join(" "))
SOURCES  := printing casting scanner registration following lvdt touches approximation tool
SETS     ?= none $(SOURCES) all
DRAWS    ?= $(call constant,.draws)
MACHINE  := samples/machines/$(call constant,.machine).json
BUDGET   ?= $(B)/budget
cells    := $(foreach p,$(PARTS),$(foreach s,$(SETS),$(foreach d,$(shell seq $(DRAWS)),$(BUDGET)/$(p)/$(s)/$(d))))

.PHONY: budget
budget: $(cells:%=%/errors.json) $(patsubst %,%/form.json,$(filter $(BUDGET)/wang1/all/% $(BUDGET)/wang2/all/%,$(cells)))
	@pipelines/budget-table $(BUDGET) "$(PARTS)" "$(SETS)" $(DRAWS)

include pipelines/step.mk
.SECONDEXPANSION:

# % is PART/SET/DRAW.
part = $(word 1,$(subst /, ,$1))
set  = $(word 2,$(subst /, ,$1))
draw = $(word 3,$(subst /, ,$1))
# $(call on,%,SOURCE,OPTIONS): the options where the source is in the set. A draw has the same errors in every set.
on   = $(if $(filter all $2,$(call set,$1)),$3)
of   = $(call constant,.$1)

printing_options     := --warp $(call of,printing.warp) --wavelength $(call of,printing.wavelength)
casting_options      := --warp $(call of,casting.warp) --wavelength $(call of,casting.wavelength) --shrinkage $(call of,casting.shrinkage)
scanner_options      := --noise $(shell jq -n '$(call of,scanner.noise) * pow(2; 0.5)')
registration_options := --shift $(call of,registration.shift) --turn $(call of,registration.turn_deg)
lvdt_options         := --lvdt --lvdt-offset $(call of,lvdt.offset)
touches_options      := --noise $(call of,touches)
# Griddata takes the operator's points of the sampling boundary, too, which he has touched on this part.
boundary_option       = $(if $(filter griddata,$(call of,methods.$(call part,$1).wang)),--sampling-boundary)
disturb              := $(B)/study/disturb
# Every draw of every source has its own seed.
seed                  = --seed $(shell echo $$(($(call draw,$1) * 10 + $2)))

$(BUDGET)/parts/%.stl: samples/parts/%.json $(B)/bin/fettle-part
	$(call step,$(B)/bin/fettle-part $< > $@.part)

$(BUDGET)/parts/%-truth.stl: samples/parts/%.json $(B)/bin/fettle-part
	$(call step,$(B)/bin/fettle-part $< --without-anomaly > $@.part)

# The epoxy part, and the comparison part, which was printed, not cast.
$(BUDGET)/%/stock.stl: $(BUDGET)/parts/$$(call part,$$*).stl $(disturb) $(CONSTANT)
	$(call step,$(disturb) $< --file-units in $(call on,$*,printing,$(printing_options)) $(call seed,$*,1) | $(disturb) - --file-units in $(call on,$*,casting,$(casting_options)) $(call seed,$*,2) > $@.part)

$(BUDGET)/%/compared.stl: $(BUDGET)/parts/$$(call part,$$*)-truth.stl $(disturb) $(CONSTANT)
	$(call step,$(disturb) $< --file-units in $(call on,$*,printing,$(printing_options)) $(call seed,$*,3) > $@.part)

$(BUDGET)/%/job.json: samples/jobs/$$(call part,$$*).json $(CONSTANT) pipelines/jq/budget_job.jq
	$(call step,jq --slurpfile all $(CONSTANT) --arg tool "$(call on,$*,tool,tool)" -f pipelines/jq/budget_job.jq $< > $@.part)

$(BUDGET)/%/plan.json: $(BUDGET)/%/job.json $(BUDGET)/%/stock.stl $(addprefix $(B)/bin/fettle-,sample estimate fit plan)
	$(call step,$(B)/bin/fettle-sample $< --on $(@D)/stock.stl --strategy wang $(call on,$*,touches,$(touches_options)) $(call on,$*,approximation,$(call boundary_option,$*)) $(call seed,$*,7) | $(B)/bin/fettle-estimate $< \
	    | $(B)/bin/fettle-fit $< --method $(call of,methods.$(call part,$*).$(or $(call on,$*,approximation,wang),exact)) | $(B)/bin/fettle-plan $< > $@.part)

# The table reports a run that does not finish.
$(BUDGET)/%/ground.pcd: $(BUDGET)/%/plan.json $(MACHINE) $(B)/study/budget-grind
	$(call step,$(B)/study/budget-grind $< --stock $(@D)/stock.stl --machine $(MACHINE) $(call on,$*,following,--following) $(call on,$*,lvdt,$(lvdt_options)) \
	    $(call on,$*,tool,--wear) $(call seed,$*,6) --report $(@D)/grind.json > $@.part || test $$? = 1)

$(BUDGET)/%/scanned.pcd: $(BUDGET)/%/ground.pcd $(disturb)
	$(call step,$(disturb) $< --cloud $(call on,$*,scanner,$(scanner_options)) $(call seed,$*,4) | $(disturb) - --cloud $(call on,$*,registration,$(registration_options)) $(call seed,$*,5) > $@.part)

# Out of the job's tolerance (exit 1) is a result like another.
$(BUDGET)/%/errors.json: $(BUDGET)/%/scanned.pcd $(BUDGET)/%/compared.stl $(B)/bin/fettle-compare
	$(call step,$(B)/bin/fettle-compare $< --to $(@D)/compared.stl --mode z --within $(@D)/job.json --report $@.part -q -o $@.map.pcd || test $$? = 1; rm -f $@.map.pcd)

$(BUDGET)/%/form.json: $(BUDGET)/%/scanned.pcd $(B)/bin/fettle-form
	$(call step,$(B)/bin/fettle-form $(if $(filter wang1,$(call part,$*)),flatness,cylindricity) $< --within $(@D)/job.json > $@.part)
