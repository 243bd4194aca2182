# The error band of Wang's modified griddata and of the default fit on the same touches: three patches of 5 x 4 in, each
# with an anomaly of 2 x 2 in (16 touches) and of 1 x 1 in (8 touches, one line each way), touch noise normal:0.005.
#
#   make -f pipelines/bands.mk -j2            a table beside Wang 2007, Table 4-5; exit 1 if a figure is missed
#   make -f pipelines/bands.mk SEEDS=10       with fewer draws of the noise
#   make -f pipelines/bands.mk NOISE=uniform:0.005

B      ?= build
SEEDS  ?= 100
NOISE  ?= normal:0.005
BANDS  := $(B)/bands/$(subst :,-,$(NOISE))
export PATH := $(abspath $(B)/bin):$(PATH)

PATCHES := concave convex saddle
SIZES   := 2x2 1x1
CASES   := $(foreach patch,$(PATCHES),$(SIZES:%=$(patch)_%))
CHAINS  := $(foreach seed,$(shell seq $(SEEDS)),$(CASES:%=$(BANDS)/$(seed)/%))
TOOLS   := $(addprefix $(B)/bin/fettle-,part sample estimate fit mesh compare)

include pipelines/step.mk
.SECONDEXPANSION:
.PHONY: bands

bands: $(CHAINS:%=%/griddata.json) $(CHAINS:%=%/bspline.json)
	@pipelines/bands-table $(BANDS) $(SEEDS) $(CASES)

# A path is $(BANDS)/SEED/CASE/STAGE; % is SEED/CASE.
case  = $(notdir $1)
seed  = $(patsubst %/,%,$(dir $1))
job   = samples/jobs/patch_$(call case,$1).json
truth = $(BANDS)/$(firstword $(subst _, ,$(call case,$1))).stl
lines = $(if $(findstring 1x1,$1),1,2)

$(BANDS)/%.stl: samples/parts/patch_%_2x2.json samples/parts/patch_%.json $(TOOLS)
	$(call step,fettle-part $< --without-anomaly -o $@.part)

$(BANDS)/%/points.pcd: $$(call job,$$*) $$(call truth,$$*)
	$(call step,fettle-sample $< --on $(call truth,$*) --strategy wang --lines $(call lines,$*) --noise $(NOISE) --seed $(call seed,$*) | \
	    fettle-estimate $< -o $@.part)

# $1: the method. fettle-compare exits 1 out of tolerance, which is a result like another here.
band = $(call step,fettle-fit $< $(@D)/points.pcd --method $1 | fettle-mesh --step 0.05 --within $< | \
    (fettle-compare --to $(call truth,$*) --mode z --within $< --report $@.part -o /dev/null || [ $$? -eq 1 ]))

$(BANDS)/%/griddata.json: $$(call job,$$*) $(BANDS)/%/points.pcd
	$(call band,griddata)

$(BANDS)/%/bspline.json: $$(call job,$$*) $(BANDS)/%/points.pcd
	$(call band,bspline)
