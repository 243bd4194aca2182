# How near `auto` comes to what statistics allow, and how honest its sigma, its margin and its bands are: on surfaces of
# every family and of none, with Wang's layout of touches (2007, 4.5), 99 % of them within 0.005 in.
#
#   make -f pipelines/calibration.mk -j2                 the table; exit 1 if a figure is missed
#   make -f pipelines/calibration.mk -j2 CELLS=50        fewer cells of each kind
#   make -f pipelines/calibration.mk -j100 LAUNCH='srun -Q -n1 -c1 --quit-on-interrupt'
#
# A step is a batch: the cells of one kind of surface by all methods. CALIBRATION/SEED/KIND.csv holds them, a line each.

B           ?= build
CELLS       ?= 1000
SEED        ?= 1
CALIBRATION ?= $(B)/calibration/cells-$(CELLS)/$(SEED)
FAMILIES    := plane sphere_convex sphere_concave cylinder cylinder_turned saddle saddle_turned cone
NEAR        := torus hull
OTHERS      := bump wave franke1 franke3

.PHONY: calibration
calibration: $(patsubst %,$(CALIBRATION)/%.csv,$(FAMILIES) $(NEAR) $(OTHERS))
	@pipelines/calibration-table $(CALIBRATION) "$(FAMILIES)" "$(NEAR)" "$(OTHERS)"

include pipelines/step.mk

$(FAMILIES:%=$(CALIBRATION)/%.csv): METHODS := auto auto+scan
$(NEAR:%=$(CALIBRATION)/%.csv) $(OTHERS:%=$(CALIBRATION)/%.csv): METHODS := auto gp griddata

$(CALIBRATION)/%.csv: $(B)/study/calibration
	$(call step,$< $* $(CELLS) $(SEED) $(METHODS) > $@.part)
