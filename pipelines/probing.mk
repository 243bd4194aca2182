# How many touches `fettle-sample --strategy adaptive` needs for the error band that Wang's layout reaches, whether the band
# that it foresees when it stops holds, and what is left on Wang's parts after grinding with at most 30 of them. The
# surfaces, their cells and the touches' noise are those of calibration.mk.
#
#   make -f pipelines/probing.mk -j2                 the tables; exit 1 if a figure is missed
#   make -f pipelines/probing.mk -j2 CELLS=20        fewer cells of each kind
#   make -f pipelines/probing.mk -j2 bands           the cells only
#   make -f pipelines/probing.mk -j2 parts           Wang's parts only
#   make -f pipelines/probing.mk -j100 LAUNCH='srun -Q -n1 -c1 --quit-on-interrupt'
#
# A step is a batch: the cells of one kind of surface. PROBING/SEED/KIND.csv holds them, a line each.

B        ?= build
CELLS    ?= 200
SEED     ?= 1
PROBING  ?= $(B)/probing/cells-$(CELLS)/$(SEED)
SURFACES ?= sphere_convex sphere_concave cylinder cylinder_turned saddle saddle_turned torus hull
OTHERS   ?= bump wave
# Draws of the touches' noise on Wang's parts.
DRAWS    ?= 5

.PHONY: probing bands parts
probing:
	@status=0; for part in bands parts; do                                                                           \
	    $(MAKE) --no-print-directory -f pipelines/probing.mk $$part || status=1; done; exit $$status

bands: $(SURFACES:%=$(PROBING)/%.csv) $(OTHERS:%=$(PROBING)/%.csv)
	@pipelines/probing-table $(PROBING) "$(SURFACES)" "$(OTHERS)"

include pipelines/step.mk

$(PROBING)/%.csv: $(B)/study/probing
	$(call step,$< $* $(CELLS) $(SEED) > $@.part)

# The chain of casting.mk in a folder of its own.
TOUCHED := $(B)/probing/chain
WANG    := wang1 wang2 wang3
ERRORS  := $(foreach draw,$(shell seq $(DRAWS)),$(WANG:%=$(TOUCHED)/$(draw)/%/errors.pcd))

parts:
	@$(MAKE) --no-print-directory -f pipelines/casting.mk CHAIN=$(TOUCHED) \
	    SAMPLING='--strategy adaptive --max-touches 30' $(ERRORS)
	@pipelines/probing-parts $(TOUCHED) $(DRAWS) $(WANG)
