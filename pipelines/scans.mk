# How honest the margin is on real surfaces: cells cut from three scans where they are one face, each touched as fettle-sample does
# (Wang's layout, and the default, which goes on from there), fitted by auto, compared with the scan inside B.
#
#   make -f pipelines/scans.mk -j2                 the table; exit 1 if a figure is missed
#   make -f pipelines/scans.mk -j2 CELLS=20        fewer cells of each scan
#
# A step is the cells of one scan. SCANS/SEED/NAME.csv holds them, a line a cell and strategy.

B     ?= build
CELLS ?= 340
SEED  ?= 1
SCANS ?= $(B)/scans/cells-$(CELLS)/$(SEED)
NAMES := hammer panel weld

.PHONY: scans
scans: $(NAMES:%=$(SCANS)/%.csv)
	@pipelines/scans-table $(SCANS) "$(NAMES)"

include pipelines/step.mk

# Sides of B, mm: what the scan has room for.
OF_hammer := samples/scans/hammer.stl mm 6 20
OF_panel  := samples/scans/panel.pcd m 40 120
OF_weld   := $(B)/chain/parts/weld.obj mm 10 40

$(B)/chain/parts/weld.obj:
	@$(MAKE) --no-print-directory -s -f pipelines/casting.mk B=$(B) $@

$(SCANS)/weld.csv: | $(B)/chain/parts/weld.obj
$(NAMES:%=$(SCANS)/%.csv): $(SCANS)/%.csv: $(B)/study/scans
	$(call step,$< $(OF_$*) $(CELLS) $(SEED) > $@.part)
