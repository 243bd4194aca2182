# The tables and figures of Wang 2007, chapter 4, measured beside the published ones: 4-1 to 4-5, the line of 4.4.2, figures
# 4-4, 4-8 (with the 0.22 of eq. 4-3), 4-9 and 4-10, and the five surfaces of 4.5.
#
#   make -f pipelines/tables.mk -j2                     the tables and pictures; exit 1 if a bar is missed
#   make -f pipelines/tables.mk -j2 RUNS=50             as many searches a cell as in the paper
#   make -f pipelines/tables.mk -j100 LAUNCH='srun -Q -n1 -c1 --quit-on-interrupt'
#
# A step is one search (some seconds), or all trials of a table. TABLES/NAME.txt holds its values, values.txt all of them.

B         ?= build
RUNS      ?= 10
MUTATIONS ?= 200
TRIALS    ?= 100
# Spacing of the candidates, in; 0: about a thousand places.
BETWEEN   ?= 0
TABLES    ?= $(B)/tables/runs-$(RUNS)-$(MUTATIONS)-$(TRIALS)-$(BETWEEN)

PATCHES := concave convex saddle
SIZES   := 2x2 1x1
CASES   := $(foreach patch,$(PATCHES),$(SIZES:%=$(patch)_%))
RADII   := 25 10 7.5 5

# Searches of Tables 4-1 and 4-4 have the middle of the anomaly 2 in from a short side (figure 4-9), those of Table 4-5 are
# on the same jobs as the simple strategy.
BARE    := concave_2x2-bare concave_2x2-spline concave_2x2-spline-bare
# Searches whose errors reach to 0.7 in from the edge of S, not to the edge of the anomaly; an evaluation takes longer, and there are fewer.
OVER    := $(foreach case,$(filter %_2x2,$(CASES)),best/$(case)-over)
OVER_MUTATIONS ?= 20
OVER_BETWEEN   ?= 0.3
CELLS   := $(CASES:%=climb/%) $(BARE:%=climb/%) $(CASES:%=best/%) $(OVER)
SEARCHES := $(foreach run,$(shell seq $(RUNS)),$(CELLS:%=$(TABLES)/%/$(run).txt))
# Guesses about what the paper leaves open, with the options that make them.
GUESSES := as-is none normal sigma linear once half coarse corners over-sampling largest anywhere anywhere-cubic anywhere-coarse swapped two one two-over-sampling two-linear
guess_none            := --noise none
guess_normal          := --noise normal
guess_sigma           := --noise sigma
guess_linear          := --linear
guess_once            := --spacing 0
guess_half            := --spacing 0.5
guess_coarse          := --spacing 0.7
guess_corners         := --corners
guess_over-sampling   := --over-sampling
guess_largest         := --largest
guess_anywhere        := --anywhere
guess_anywhere-cubic  := --anywhere --one-cubic
guess_anywhere-coarse := --anywhere --one-cubic --spacing 0.7
guess_two-over-sampling := --over-sampling
guess_two-linear      := --linear
lines_swapped         := --lines swapped
lines_two-over-sampling := --lines two
lines_two-linear      := --lines two
lines_two             := --lines two
lines_one             := --lines one
OTHERS  := $(TABLES)/planes.txt $(TABLES)/waves.txt $(TABLES)/pairs.txt $(TABLES)/others.txt $(TABLES)/curves.txt                              \
           $(RADII:%=$(TABLES)/least/%.txt) $(CASES:%=$(TABLES)/simple/%.txt) $(GUESSES:%=$(TABLES)/guess/%.txt)

.PHONY: tables
tables: $(TABLES)/values.txt $(TABLES)/figures.png $(TABLES)/figure-4-4-before.png $(TABLES)/figure-4-4-after.png
	@$(B)/study/tables-table $<
	@echo; echo "pictures: $(TABLES)/*.png"

include pipelines/step.mk
.SECONDEXPANSION:

# A cell is KIND/CASE[-OPTION…], its stem KIND/CASE[-OPTION…]/RUN.
cell    = $(patsubst %/,%,$(dir $1))
case    = $(firstword $(subst -, ,$(notdir $(call cell,$1))))
job     = samples/jobs/patch_$1.json
patch   = samples/parts/patch_$(firstword $(subst _, ,$1)).json
small   = $(findstring 1x1,$1)
lines   = --lines $(if $(small),1,2)
options = $(if $(findstring spline,$1),--spline) $(if $(findstring bare,$1),--without-estimated) $(if $(findstring over,$1),--inset 0.7)
# Uniform sampling, in: with it all candidates together have about the band that the paper's searches end with.
spacing = --spacing $(if $(small),0.6,0.7)
search  = $(if $(findstring best/,$1),--touches $(if $(small),8,16) --sharpness 1000,--shift -0.5 --sharpness $(if $(small),100,60))

$(SEARCHES): $(TABLES)/%.txt: $(B)/study/tables-climb $$(call job,$$(call case,$$*)) $$(call patch,$$(call case,$$*))
	$(call step,$(wordlist 1,3,$^) --name $(call cell,$*) --first $(notdir $*)                                         \
	    --mutations $(if $(findstring over,$*),$(OVER_MUTATIONS),$(MUTATIONS)) --candidates $(if $(findstring over,$*),$(OVER_BETWEEN),$(BETWEEN)) $(call lines,$*) $(call spacing,$*) $(call options,$*) $(call search,$*)                 \
	    --threads 1 -o $@.part)

$(TABLES)/planes.txt: $(B)/study/tables-planes
	$(call step,$< --batches $(TRIALS) --threads 1 -o $@.part)

$(TABLES)/others.txt: $(B)/study/tables-others
	$(call step,$< --trials $(TRIALS) --threads 1 -o $@.part)

WAVES := $(call job,concave_2x2) $(call patch,concave_2x2)
$(TABLES)/waves.txt: $(B)/study/tables-waves $(WAVES)
	$(call step,$< $(WAVES) --trials $(TRIALS) --threads 1 -o $@.part)

# Figure 4-4 shows points that make a wavy surface; pairs do.
$(TABLES)/pairs.txt: $(B)/study/tables-waves $(WAVES)
	$(call step,$< $(WAVES) --trials $(TRIALS) --pairs --name 4-4/pairs --before $(@D)/before.pcd --after $(@D)/after.pcd --threads 1 -o $@.part)

$(TABLES)/curves.txt: $(B)/study/tables-estimated $(WAVES)
	$(call step,$< 4-3 --job $(call job,concave_2x2) --patch $(call patch,concave) --trials $(TRIALS) --threads 1 -o $@.part)

$(RADII:%=$(TABLES)/least/%.txt): $(TABLES)/least/%.txt: $(B)/study/tables-estimated
	$(call step,$< 4-8 --radius $* --threads 1 -o $@.part)

$(CASES:%=$(TABLES)/simple/%.txt): $(TABLES)/simple/%.txt: $(B)/study/tables-estimated $$(call job,$$*) $$(call patch,$$*)
	$(call step,$< 4-5 --job $(call job,$*) --patch $(call patch,$*) --name simple/$* $(call lines,$*) --trials $(TRIALS) \
	    --threads 1 -o $@.part)

# A fifth of the trials, since there are many guesses. EVERY: of the 21 radii of the factorial experiment, every Nth.
GUESSED := $(shell echo $$((($(TRIALS) + 4) / 5)))
EVERY   ?= 5
curves   = $(B)/study/tables-estimated $1 --job $(call job,$2) --patch $(call patch,$2) --name simple/$2 --lines $(if $(findstring 1x1,$2),1,2) --trials $(GUESSED) --threads 1
$(GUESSES:%=$(TABLES)/guess/%.txt): $(TABLES)/guess/%.txt: $(B)/study/tables-estimated $(B)/study/tables-regression $(foreach c,$(CASES),$(call job,$c) $(call patch,$c))
	$(call step,{ $(call curves,4-3,concave_2x2) $(guess_$*) && $(call curves,gain,concave_2x2) $(guess_$*) && $(foreach c,$(CASES),$(call curves,4-5,$c) $(guess_$*) &&) \
	    $(B)/study/tables-regression --every $(EVERY) $(guess_$*) $(lines_$*) --threads 1; } > $@.raw && sed "s|^|guess/$*/|" $@.raw > $@.part && rm $@.raw)

$(TABLES)/values.txt: $(SEARCHES) $(OTHERS)
	@cat $(sort $^) > $@

$(TABLES)/figures.png: $(TABLES)/values.txt $(B)/study/tables-chart
	@$(B)/study/tables-chart $< -o $@

# The waves alone, of one colour scale: of heights the pair looks alike. The first trial is drawn, and its waves are the first of pairs.txt.
$(TABLES)/figure-4-4-%.png: $(TABLES)/pairs.txt $(B)/bin/fettle-render
	@$(B)/bin/fettle-render $(@D)/$*.pcd --field error --scale 0.05 --within $(call job,concave_2x2) \
	    --title "griddata $* resampling: waves of $$(awk '$$1 == "4-4/pairs/$*" { printf "%.4f", $$2; exit }' $<) in rms" -o $@
