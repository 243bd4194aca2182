# The chain, from a part with an anomaly to an error map, for each case in samples/: one rule a stage.
#
#   make -f pipelines/casting.mk demo       a real weld, real scans and Wang's parts: a table, pictures and pages in $(CHAIN)
#   make -f pipelines/casting.mk figures    the chain's figures beside what they must reach; exit 1 if one is missed
#   make -f pipelines/casting.mk hills      the hills and the moon of Wang 2007, figure 5-8
#   make -f pipelines/casting.mk seeds      how all cases fare over 20 draws of the touch noise; exit 1 if a figure is missed
#   make -f pipelines/casting.mk holdout    the weld's boundaries laid over sound metal, which says what is beneath: 20 draws
#   make -f pipelines/casting.mk ways       Wang's published figures, his way here, the default and adaptive touches: a table
#
# METHOD=wang goes Wang's way (2007) from end to end: his touches with the measured sampling boundary, estimated points, modified
# griddata (planes: least squares; swept: his section curve), the shift of his regressions (planes: the probe's accuracy), his layers.
# METHOD=adaptive chooses the touches one after the other. Both take a folder of their own.
#
# The case and the seed are part of the path, so make is the cache and -j the scheduler.

B       ?= build
METHOD  ?= default
CHAIN   := $(B)/chain$(if $(filter-out default,$(METHOD)),-$(METHOD))
export PATH := $(abspath $(B)/bin):$(PATH)
# Further options of fettle-sample; with them, a CHAIN of its own (probing.mk).
SAMPLING ?=

WANG    := wang1 wang2 wang3
SCANS   := hammer panel
# The scan of a part with its own anomaly: nobody knows what is beneath, so its truth is the design, which the part is warped against.
REAL    := weld
# Parts in mm whose surface is of no family that fettle-fit knows.
OTHERS  := bumps crown fillet
HILLS   := hill hills moon
CLOUDS  := panel
# 99 % of the touches within ±0.005 in; the scans' jobs are in mm.
NOISE_in := normal:0.005
NOISE_mm := normal:0.127
# Cells of the stock: 0.1 mm on the parts in inches, too. Steps of the grid on which a fit meets the truth.
CELL_in := 0.003937
CELL_hammer := 0.1
CELL_panel := 0.5
CELL_weld := 0.1
$(foreach case,$(OTHERS),$(eval CELL_$(case) := 0.1))
STEP_in := 0.02
STEP_hammer := 0.5
STEP_panel := 1
STEP_weld := 0.5
$(foreach case,$(OTHERS),$(eval STEP_$(case) := 0.5))
# Verdict: the ground surface lies within ± this of the truth; 0.4 mm, for the rough panel 1 mm, and 0.8 mm against the design of
# the weld's part, whose sound metal beside the weld is up to 0.84 mm off it.
LIMIT_in := 0.0157
LIMIT_hammer := 0.4
LIMIT_panel := 1
LIMIT_weld := 0.8
$(foreach case,$(OTHERS),$(eval LIMIT_$(case) := 0.4))

.DELETE_ON_ERROR:
.SECONDARY:
.SECONDEXPANSION:
.PHONY: demo figures hills seeds draws ways holdout
ifeq ($(filter default wang adaptive,$(METHOD)),)
$(error METHOD is default, wang or adaptive, not $(METHOD))
endif

# The options of METHOD. Wang's follow from the job's kind of surface, its first prerequisite.
by_surface          = $$(jq -r '{$1}[.surface.type] // empty' $<)
sampling_of_wang     = --strategy wang $(call by_surface,freeform: "--sampling-boundary")
sampling_of_adaptive = --strategy adaptive
fit_of_wang          = --method $(call by_surface,plane: "plane"$(comma) swept: "swept"$(comma) freeform: "griddata")
# The rough panel is touched one by one up to the limit of 60: its band never meets the tolerance.
sampling_panel       = $(if $(filter default,$(METHOD)),--strategy adaptive)
margin_of_wang       = --method wang --plane-shift accuracy
# With 99 % the rough panel's margin alone takes half of its limit, for the one facet in hundreds that may stand highest.
margin_panel         = $(if $(filter wang,$(METHOD)),,--confidence 0.9)
# Rough metal: by the touches alone 7 of 120 runs of holdout lie beneath it, where 1.2 are due; its scan shows the waves.
margin_weld          = $(if $(filter wang,$(METHOD)),,--scan $(CHAIN)/parts/weld.obj --scan-units mm)
comma               := ,

# A path is $(CHAIN)/SEED/CASE/STAGE; % is SEED/CASE.
case   = $(notdir $1)
seed   = $(patsubst %/,%,$(dir $1))
job    = samples/jobs/$(call case,$1).json
spec   = samples/parts/$(call case,$1).json
form   = $(if $(filter $(CLOUDS),$(call case,$1)),pcd,$(if $(filter $(REAL),$(call case,$1)),obj,stl))
part   = $(CHAIN)/parts/$(call case,$1).$(call form,$1)
truth  = $(if $(filter $(REAL),$(call case,$1)),samples/designs/$(call case,$1).stl,$(CHAIN)/parts/$(call case,$1)-truth.$(call form,$1))
is_mm  = $(filter $(SCANS) $(REAL) $(OTHERS),$(call case,$1))
noise  = $(NOISE_$(if $(is_mm),mm,in))
cell   = $(CELL_$(or $(is_mm),in))
step   = $(STEP_$(or $(is_mm),in))
limit  = $(LIMIT_$(or $(is_mm),in))
units  = $(if $(is_mm),mm,in)

# --- the stages -------------------------------------------------------------------------------------------------------
$(CHAIN)/parts/%.stl $(CHAIN)/parts/%.pcd: samples/parts/%.json $(B)/bin/fettle-part
	@mkdir -p $(@D)
	fettle-part $< -o $@

$(CHAIN)/parts/%-truth.stl $(CHAIN)/parts/%-truth.pcd: samples/parts/%.json $(B)/bin/fettle-part
	@mkdir -p $(@D)
	fettle-part $< --without-anomaly -o $@

# A profiler's scan, raw: metres in the robot's frame. It is laid into the machine's frame, and its profiles become a mesh.
$(REAL:%=$(CHAIN)/parts/%.obj): $(CHAIN)/parts/%.obj: samples/scans/%.txt.gz samples/scans/%-placement.txt samples/designs/%.stl $(B)/bin/fettle-align pipelines/profiles-mesh
	@mkdir -p $(@D)
	zcat $< | awk -F, '{ printf "%.3f %.3f %.3f\n", 1000 * $$1, 1000 * $$2, 1000 * $$3 }' > $(@D)/$*.xyz
	fettle-align $(@D)/$*.xyz --file-units mm --to samples/designs/$*.stl --to-units mm --transform-in samples/scans/$*-placement.txt \
	    --iterations 0 -q --ascii -o $(@D)/$*.pcd
	GAP=50 pipelines/profiles-mesh $(@D)/$*.pcd > $@

$(CHAIN)/%/samples.pcd: $$(call job,$$*) $$(call part,$$*) $(B)/bin/fettle-sample
	@mkdir -p $(@D)
	fettle-sample $< --on $(call part,$*) $(sampling_of_$(METHOD)) $(sampling_$(call case,$*)) $(SAMPLING) --noise $(call noise,$*) --seed $(call seed,$*) --report $(@D)/sample.json -o $@

$(CHAIN)/%/fit.json: $$(call job,$$*) $(CHAIN)/%/samples.pcd $(B)/bin/fettle-fit $(B)/bin/fettle-estimate
	fettle-estimate $< $(@D)/samples.pcd | fettle-fit $< $(fit_of_$(METHOD)) -o $@

$(CHAIN)/%/desired.json: $$(call job,$$*) $(CHAIN)/%/fit.json $(B)/bin/fettle-margin
	fettle-margin $< $(@D)/fit.json $(margin_of_$(METHOD)) $(margin_$(call case,$*)) -o $@

$(CHAIN)/%/plan.json: $$(call job,$$*) $(CHAIN)/%/desired.json $(B)/bin/fettle-plan
	fettle-plan $< $(@D)/desired.json -o $@

$(CHAIN)/%/ground.pcd: $(CHAIN)/%/plan.json $$(call part,$$*) $(B)/bin/fettle-grind
	fettle-grind $< --stock $(call part,$*) --gantry virtual --cell $(call cell,$*) --trace $(@D)/trace.pcd \
	    --report $(@D)/grind.json -o $@

# Out of tolerance (exit 1) is a result like another here: the table shows it.
$(CHAIN)/%/errors.pcd: $(CHAIN)/%/ground.pcd $$(call truth,$$*) $(B)/bin/fettle-compare
	fettle-compare $< --to $(call truth,$*) --within $(call job,$*) --tolerance $(call limit,$*) \
	    --report $(@D)/errors.json -o $@ || test $$? -eq 1

# What of the truth the wheel has taken.
$(CHAIN)/%/over.txt: $(CHAIN)/%/errors.pcd pipelines/over_ground
	pipelines/over_ground $< > $@

# The error of the fit itself, before the margin: its band is what the margin foretold.
$(CHAIN)/%/band.json: $(CHAIN)/%/fit.json $$(call truth,$$*) $(B)/bin/fettle-mesh $(B)/bin/fettle-compare
	fettle-mesh $< --within $(call job,$*) --step $(call step,$*) |                                                  \
	    fettle-compare - --to $(call truth,$*) --within $(call job,$*) --mode z --report $@ -o /dev/null || test $$? -eq 1

# --- form of the ground parts 1 and 2 -------------------------------------------------------------------------------------
$(CHAIN)/%/flatness.json: $$(call job,$$*) $(CHAIN)/%/ground.pcd $(B)/bin/fettle-form
	fettle-form flatness $(@D)/ground.pcd --within $< -o $@

$(CHAIN)/%/cylindricity.json: $$(call job,$$*) $(CHAIN)/%/ground.pcd $(B)/bin/fettle-form
	fettle-form cylindricity $(@D)/ground.pcd --within $< -o $@

# --- pictures ---------------------------------------------------------------------------------------------------------
# Each says what it shows; a picture's letters have no superscript.
before_title = $$(jq -r '[.removed_volume, .units.length] | @tsv' $(@D)/grind.json | awk '{ printf ($$1 < 999.5 ? "%.3g" : "%.0f") " cubic %s to grind off", $$1, $$2 }')
after_title  = $$(jq -r '[.layers, .machine_time / 60] | @tsv' $(@D)/grind.json | awk '{ printf "ground in %d layer%s and %.1f minutes", $$1, $$1 == 1 ? "" : "s", $$2 }')

$(CHAIN)/%/before.png: $$(call job,$$*) $$(call part,$$*) $(CHAIN)/%/ground.pcd $(B)/bin/fettle-render
	fettle-render $(call part,$*) --file-units $(call units,$*) --within $< --title "$(call case,$*), before: $(before_title)" -o $@

$(CHAIN)/%/after.png: $$(call job,$$*) $(CHAIN)/%/ground.pcd $(B)/bin/fettle-render
	fettle-render $(@D)/ground.pcd --field z --within $< --title "$(call case,$*), after: $(after_title)" -o $@

$(CHAIN)/%/errors.png: $$(call job,$$*) $(CHAIN)/%/errors.pcd $(B)/bin/fettle-render
	fettle-render $(@D)/errors.pcd --within $< \
	    --title "$(call case,$*): $$(jq -r '"\(1000 * .regions.inside.within | floor / 10) % inside B within \(.tolerance) \(.units.length)"' $(@D)/errors.json) of the reference" -o $@

# The page takes the plan's job and surface; everything of the run is on it.
$(CHAIN)/%/report.html: $$(call job,$$*) $$(call part,$$*) $(CHAIN)/%/errors.pcd $(B)/bin/fettle-report
	fettle-report --title "$(call case,$*): ground to its desired surface" --job $< --samples $(@D)/samples.pcd \
	    --surface $(@D)/desired.json --plan $(@D)/plan.json --grinding $(@D)/grind.json --trace $(@D)/trace.pcd \
	    --before $(call part,$*) --before-units $(call units,$*) --after $(@D)/ground.pcd \
	    --errors $(@D)/errors.pcd --comparison $(@D)/errors.json -o $@

# --- requested files -------------------------------------------------------------------------------------------------
SHOWN    := $(REAL) $(SCANS) $(WANG)
results   = $(foreach c,$2,$(addprefix $(CHAIN)/$1/$c/,errors.pcd band.json))
pictures  = $(foreach c,$2,$(addprefix $(CHAIN)/$1/$c/,before.png after.png errors.png report.html))

# Times and forms of one draw, then what twenty leave.
W := $(CHAIN)/1
figures: $(call results,1,$(WANG)) $W/wang1/flatness.json $W/wang2/cylindricity.json
	@status=0; pipelines/chain-figures $(CHAIN) $(abspath $(B)/bin) || status=1;                                     \
	    $(MAKE) --no-print-directory -s -f pipelines/casting.mk B=$(B) CHAIN=$(CHAIN) seeds || status=1;              \
	    $(MAKE) --no-print-directory -s -f pipelines/casting.mk B=$(B) CHAIN=$(CHAIN) holdout || status=1;            \
	    $(MAKE) --no-print-directory -f pipelines/bands.mk B=$(B) || status=1;                                        \
	    $(MAKE) --no-print-directory -s -f pipelines/calibrate.mk B=$(B) || status=1; exit $$status

# One row a case: how much of the figures is the luck of the draw.
SEEDS ?= 20
CASES := $(WANG) $(SCANS) $(REAL) $(OTHERS)
seeds: $(foreach s,$(shell seq $(SEEDS)),$(foreach c,$(CASES),$(CHAIN)/$s/$c/over.txt))
	@pipelines/seeds-table $(CHAIN) $(SEEDS) $(CASES)

# The boundaries of the weld's job, shifted so that they lie on sound metal, as if an anomaly lay there: what is beneath is known, it is the scan.
# No other place has room between the weld, a seam, and the edges.
PLACES := -60_30 -30_30 -5_32 -60_-25 -30_-25 -10_-29
held    = $(foreach s,$1,$(PLACES:%=$(CHAIN)/$s/holdout/%.json))
holdout: $$(call held,$$(shell seq $$(SEEDS)))
	@pipelines/holdout-table $(CHAIN) $(SEEDS) "$(PLACES)"

$(CHAIN)/holdout/%.json: samples/jobs/weld.json
	@mkdir -p $(@D)
	jq --argjson x $(word 1,$(subst _, ,$*)) --argjson y $(word 2,$(subst _, ,$*)) '(.anomaly, .sampling) |= map([.[0] + $$x, .[1] + $$y])' $< > $@

define holdout_rule
$(CHAIN)/%/holdout/$1.json: $(CHAIN)/holdout/$1.json $(CHAIN)/parts/weld.obj $(addprefix $(B)/bin/fettle-,sample fit margin mesh compare)
	@mkdir -p $$(@D)
	fettle-sample $$< --on $(CHAIN)/parts/weld.obj --noise $(NOISE_mm) --seed $$* --report $$(@:.json=-sample.json) -q -o $$(@:.json=.pcd)
	fettle-fit $$< $$(@:.json=.pcd) | fettle-margin $$< $$(margin_weld) -o $$(@:.json=-desired.json)
	fettle-mesh $$(@:.json=-desired.json) --within $$< --step $(STEP_weld) | fettle-compare - --to $(CHAIN)/parts/weld.obj --mode z --within $$< \
	    --tolerance $(LIMIT_weld) --report $$@ -o /dev/null || test $$$$? -eq 1
endef
$(foreach place,$(PLACES),$(eval $(call holdout_rule,$(place))))

# Wang's way, the default and adaptive touches beside what he published, over the same draws.
draws: $(foreach s,$(shell seq $(SEEDS)),$(call results,$s,$(WANG)) $(CHAIN)/$s/wang1/flatness.json $(CHAIN)/$s/wang2/cylindricity.json)

WAYS := wang default adaptive
ways:
	@for way in $(WAYS); do $(MAKE) --no-print-directory -s -f pipelines/casting.mk B=$(B) METHOD=$$way SEEDS=$(SEEDS) draws || exit; done
	@pipelines/ways-table $(B) $(SEEDS)

demo: $(call results,1,$(SHOWN)) $(call pictures,1,$(SHOWN))
	@pipelines/chain-table $(CHAIN)/1 $(SHOWN)
	@echo "pictures: $(CHAIN)/1/*/{before,after,errors}.png, pages: $(CHAIN)/1/*/report.html"

hills: $(call results,1,$(HILLS)) $(call pictures,1,$(HILLS))
	@pipelines/chain-table $(CHAIN)/1 $(HILLS)
