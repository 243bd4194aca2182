# How honest the margin is on real surfaces: cells cut from scans where they are one face, each touched as fettle-sample does
# (Wang's layout, and the default, which goes on from there), fitted by auto, compared with the scan inside B; the margin by the touches
# alone, and with the scan around B (+scan).
#
#   make -f pipelines/scans.mk -j2                 three scans of samples/: the table; exit 1 if a figure is missed
#   make -f pipelines/scans.mk -j2 DATA=FOLDER     with six more, which the rules of the study were not made on
#   make -f pipelines/scans.mk -j2 APART=FOLDER    instead of these scans twelve by which no constant was chosen
#   make -f pipelines/scans.mk -j2 CELLS=20        fewer cells of each scan
#   make -f pipelines/scans.mk -j2 STRATEGIES=wang a strategy alone
#
# FOLDER holds scans that are not fettle's to give: find/wp_waist.txt.gz of the repository that samples/scans/weld.txt.gz is from;
# scan_mesh/raw_mesh.ply, as samples/scans/panel.pcd; scan_mesh/006_mustard_bottle.obj, of the YCB objects; scan_range/rs1.pcd, toys,
# of PCL's tutorials; several/bun000.ply.gz and bun045.ply.gz, Stanford's rabbit.
# APART holds what public repositories have, by its own name: dragonStandRight_0.ply and dragonStandRight_168.ply (bing-jian/gmmreg),
# happyStandRight_0.ply (thegyro/Project4-Scan-Matching), igea.ply, nefertiti.obj and horse.ply (alecjacobson/common-3d-test-models),
# pepper.ply and turbineblade.ply (pyvista/vtk-data), 004_sugar_box_textured.obj, 005_tomato_soup_can.obj and 010_potted_meat_can.obj (YCB objects of
# RobotLocomotion/models, the cans' glTF as OBJ), downsampled.pcd (openlmd/proper).
# A step is the cells of one scan. SCANS/NAME.csv holds them, a line a cell and strategy.

B      ?= build
LEARNT := hammer panel weld
OTHERS := $(if $(DATA),waist sheet bottle toys rabbit0 rabbit45)
UNSEEN := dragon0 dragon168 happy igea horse nefertiti pepper blade soup meat sugar plate
NAMES  := $(if $(APART),$(UNSEEN),$(LEARNT) $(OTHERS))
CELLS  ?= $(if $(APART),110,$(if $(DATA),170,340))
SEED   ?= 1
STRATEGIES ?= wang wang+scan extended extended+scan
SCANS  ?= $(B)/scans/cells-$(CELLS)/$(SEED)

.PHONY: scans FORCE
scans: $(NAMES:%=$(SCANS)/%.csv)
	@pipelines/scans-table $(SCANS) "$(NAMES)" "$(if $(APART),,$(filter-out $(LEARNT),$(NAMES)))" "$(STRATEGIES)"

include pipelines/step.mk

# Sides of B, mm: what the scan has room for, and is fine enough for.
OF_hammer   := samples/scans/hammer.stl mm 8 20
OF_panel    := samples/scans/panel.pcd m 40 120
OF_weld     := $(B)/scans/weld.obj mm 10 40
OF_waist    := $(SCANS)/waist.obj mm 10 40
OF_sheet     = $(DATA)/scan_mesh/raw_mesh.ply m 40 120
OF_bottle    = $(DATA)/scan_mesh/006_mustard_bottle.obj m 10 30
OF_toys     := $(SCANS)/toys.pcd mm 6 20
OF_rabbit0  := $(SCANS)/rabbit0.ply m 6 20
OF_rabbit45 := $(SCANS)/rabbit45.ply m 6 20
OF_dragon0   = $(APART)/dragonStandRight_0.ply m 6 20
OF_dragon168 = $(APART)/dragonStandRight_168.ply m 6 20
OF_happy    := $(SCANS)/happy.ply m 6 20
OF_igea      = $(APART)/igea.ply m 6 20
OF_horse     = $(APART)/horse.ply m 10 30
OF_nefertiti = $(APART)/nefertiti.obj mm 30 90
OF_pepper    = $(APART)/pepper.ply mm 10 30
OF_soup      = $(APART)/005_tomato_soup_can.obj m 10 30
OF_meat      = $(APART)/010_potted_meat_can.obj m 10 30
OF_sugar     = $(APART)/004_sugar_box_textured.obj m 10 30
OF_plate     = $(APART)/downsampled.pcd m 6 20
# Its file does not say its unit: one by which its triangles are as long as the panel's.
OF_blade     = $(APART)/turbineblade.ply in 40 120

# Of the welded workpiece a strip is left out as wide as B of its job: a cell over the seam and its weld is no face.
HALF_STRIP := 8
$(B)/scans/weld.obj: samples/scans/weld-seam.txt samples/scans/weld.txt.gz pipelines/mesh-without
	@mkdir -p $(@D)
	@$(MAKE) --no-print-directory -s -f pipelines/casting.mk B=$(B) $(B)/chain/parts/weld.obj
	@pipelines/mesh-without $< $(HALF_STRIP) $(B)/chain/parts/weld.obj > $@

# SCANS/DATA and SCANS/APART hold the name of the folder. They get a new date only with another name: what was made from a
# folder's scans is then made again.
$(SCANS)/DATA $(SCANS)/APART: $(SCANS)/%: FORCE
	@mkdir -p $(@D)
	@echo '$($*)' | cmp -s - $@ || echo '$($*)' > $@

# The profiles of the same workpiece that samples/ does not have, and that lie close enough.
$(SCANS)/waist.obj: samples/scans/weld-seam.txt samples/scans/weld-placement.txt pipelines/mesh-without $(B)/bin/fettle-align $(SCANS)/DATA
	@mkdir -p $(@D)
	@zcat $(DATA)/find/wp_waist.txt.gz | tail -n +67097 | awk -F, '{ printf "%.3f %.3f %.3f\n", 1000 * $$1, 1000 * $$2, 1000 * $$3 }' > $(@:.obj=.xyz)
	@$(B)/bin/fettle-align $(@:.obj=.xyz) --file-units mm --to samples/designs/weld.stl --to-units mm \
	    --transform-in samples/scans/weld-placement.txt --iterations 0 -q --ascii -o $(@:.obj=.pcd)
	@GAP=50 pipelines/profiles-mesh $(@:.obj=.pcd) > $(@:.obj=-whole.obj)
	@pipelines/mesh-without $< $(HALF_STRIP) $(@:.obj=-whole.obj) > $@

# The camera looked along +z.
$(SCANS)/toys.pcd: $(B)/bin/fettle-place $(SCANS)/DATA
	@mkdir -p $(@D)
	@$< $(DATA)/scan_range/rs1.pcd --file-units m --units mm --turn x,180 -q -o $@

$(SCANS)/rabbit%.ply: $(SCANS)/DATA
	@mkdir -p $(@D)
	@gunzip -c $(DATA)/several/bun$(if $(filter 0,$*),000,0$*).ply.gz > $@

# Three lines of its header are none of a PLY's.
$(SCANS)/happy.ply: $(SCANS)/APART
	@mkdir -p $(@D)
	@grep -v '^bye' $(APART)/happyStandRight_0.ply > $@

$(foreach name,weld waist toys rabbit0 rabbit45 happy,$(eval $(SCANS)/$(name).csv: | $(firstword $(OF_$(name)))))
$(OTHERS:%=$(SCANS)/%.csv): $(SCANS)/DATA
$(UNSEEN:%=$(SCANS)/%.csv): $(SCANS)/APART
$(NAMES:%=$(SCANS)/%.csv): $(SCANS)/%.csv: $(B)/study/scans
	$(call step,$(B)/study/scans $(OF_$*) $(CELLS) $(SEED) "$(STRATEGIES)" > $@.part)
