# Scans merged from any start, in any order, beside their true poses.
#
#   make -f pipelines/merge.mk -j2                    virtual scans of a hammer from all around, one foreign scan among them: the table; exit 1 if a figure is missed
#   make -f pipelines/merge.mk -j2 SEEDS=1 COUNT=6 POINTS=20000      fewer, coarser scans
#   make -f pipelines/merge.mk -j2 bunny DATA=FOLDER  the bunny's scans bun000 and bun045 from 100 random starts
#   make -f pipelines/merge.mk -j2 bunny DATA=FOLDER STARTS=10
#
# The scans are rays of a pinhole camera (study/merge-scans): what hides behind other parts of the mesh is missing, beams that graze are lost, noise
# lies along the beam. FOLDER holds bun000.ply.gz and bun045.ply.gz of the Stanford 3D Scanning Repository (research use: not part of fettle).
# MERGE/SEED/run.json is one merging, MERGE/bunny/START.csv one start.

B       ?= build
MERGE   ?= $(B)/merge
SEEDS   ?= 1 2 3 4 5
COUNT   ?= 12
POINTS  ?= 200000
NOISE   ?= 0.03
PART    ?= samples/scans/hammer.stl
FOREIGN ?= samples/designs/plate.stl
STARTS  ?= 100
export PATH := $(abspath $(B)/bin):$(abspath $(B)/study):$(PATH)
export COUNT POINTS NOISE PART FOREIGN

.PHONY: merge bunny
merge: $(SEEDS:%=$(MERGE)/%/run.json)
	@pipelines/merge-table $^

bunny: $(patsubst %,$(MERGE)/bunny/%.csv,$(shell seq $(STARTS)))
	@pipelines/merge-bunny-table $^

include pipelines/step.mk

$(MERGE)/%/run.json: $(B)/bin/fettle-merge $(B)/bin/fettle-compare $(B)/bin/fettle-place $(B)/study/merge-scans $(B)/study/merge-check pipelines/merge-run $(PART) $(FOREIGN)
	$(call step,pipelines/merge-run $* $(@D) > $@.part)

$(MERGE)/bunny/%.csv: $(B)/bin/fettle-merge $(B)/bin/fettle-place $(B)/study/merge-check pipelines/merge-start
	$(if $(DATA),,$(error DATA=FOLDER must say where bun000.ply.gz and bun045.ply.gz are: see pipelines/merge.mk))
	$(call step,pipelines/merge-start $* $(DATA) $(@D)/$* > $@.part)
