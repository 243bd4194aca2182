# A design machined virtually and judged: path, machined part, data sheet, picture, verdict.
#
#   make -f pipelines/machining.mk                                        the mould of samples/
#   make -f pipelines/machining.mk PART=slab                              a slab, slightly curved, 1.9 m long; PART=plate: with holes
#   make -f pipelines/machining.mk corrected PART=slab                    a worn cutter, and the path corrected for it
#   make -f pipelines/machining.mk CUTTER=bull:25,5 PASSES='--scallop 0.1'   another cutter, finer passes
#   make -f pipelines/machining.mk PART=mine DESIGN=part.stl UNITS=mm STOCK=box:…   another design
#
# MACHINING/finish.nc is the program, machined.stl the part, patches.pcd the errors of its triangles, sheet.csv the data sheet,
# errors.png the picture, verdict.json the report, room.json at how many of the serious under-cuts the cutter has no room. fettle-verify judges by the closest point, since the mould has steep walls; what
# triangles cut off the rims of walls is no more than half a cell of the grid. `corrected`: worn.json is the verdict on what the WORN
# cutter leaves along the program, by patches, corrected.json that on what it leaves along corrected.nc.

B         ?= build
export PATH := $(abspath $(B)/bin):$(PATH)
PART      ?= mould
MACHINING ?= $(B)/machining/$(PART)
DESIGN    ?= samples/designs/$(PART).stl
# Ridges between passes, errors of the grid, and what is judged by, mm: the sum of the first two is within the third.
mould.UNITS := m
mould.STOCK := box:1,1,-50.8,659,659,256
mould.CUTTER := ball:25
mould.PASSES := --scallop 0.4
slab.UNITS := m
slab.STOCK := box:-928,-212,-36,928,212,45
slab.CUTTER := ball:40
slab.PASSES := --scallop 0.05
slab.WORN := ball:36
slab.GRID := 0.1
plate.UNITS := mm
plate.STOCK := box:1,1,-1,202,303,14
plate.CUTTER := flat:6
plate.PASSES := --step-over 3
UNITS     ?= $($(PART).UNITS)
STOCK     ?= $($(PART).STOCK)
CUTTER    ?= $($(PART).CUTTER)
PASSES    ?= $($(PART).PASSES)
WORN      ?= $($(PART).WORN)
GRID      ?= $(or $($(PART).GRID),0.2)
TOLERANCE ?= 0.6

.PHONY: machining corrected
machining: $(MACHINING)/errors.png $(MACHINING)/verdict.json
	@pipelines/machining-table $(MACHINING)

$(MACHINING)/finish.nc: $(DESIGN) $(B)/bin/fettle-finish
	@mkdir -p $(@D)
	$(B)/bin/fettle-finish $< --file-units $(UNITS) --cutter $(CUTTER) $(PASSES) -o $@

# Exit status 1 of the tools is an answer, which the table shows.
$(MACHINING)/machined.stl: $(MACHINING)/finish.nc $(DESIGN) $(B)/bin/fettle-mill
	$(B)/bin/fettle-mill $< --stock $(STOCK) --cutter $(CUTTER) --tolerance $(GRID) --design $(DESIGN) --design-units $(UNITS) \
	    --report $(@D)/machined.json -o $@ || test $$? = 1

$(MACHINING)/patches.pcd: $(MACHINING)/machined.stl $(DESIGN) $(B)/bin/fettle-verify
	$(B)/bin/fettle-verify $< --design $(DESIGN) --design-units $(UNITS) --tolerance $(TOLERANCE) --method closest -q \
	    --csv $(@D)/sheet.csv --z-errors $(@D)/z-errors.pcd --report $(@D)/verdict.json -o $@ || test $$? = 1
$(MACHINING)/verdict.json: $(MACHINING)/patches.pcd

# Where the cutter has no room metal stays, whatever the path: that is told apart from what the path has left.
$(MACHINING)/room.json: $(MACHINING)/patches.pcd pipelines/machining-room $(DESIGN)
	pipelines/machining-room $< $(DESIGN) $(UNITS) $(CUTTER) > $@

$(MACHINING)/errors.png: $(MACHINING)/patches.pcd $(MACHINING)/room.json $(B)/bin/fettle-render
	$(B)/bin/fettle-render $< --scale $(TOLERANCE) --from 1,-1,2 --title "$$(pipelines/machining-table $(@D) --title)" -o $@

# --- the same path with a worn cutter, and corrected ----------------------------------------------------------------------
corrected: $(MACHINING)/corrected.json
	@jq -rn --slurpfile worn $(MACHINING)/worn.json --slurpfile corrected $< \
	    '"rms of the errors with the worn cutter \($$worn[0].rms) mm, corrected \($$corrected[0].rms) mm: \($$corrected[0].rms / $$worn[0].rms)"'

MILL_WORN   = $(B)/bin/fettle-mill $< --stock $(STOCK) --cutter $(WORN) --tolerance $(GRID) --design $(DESIGN) --design-units $(UNITS) -o $@ || test $$? = 1
VERIFY_WORN = $(B)/bin/fettle-verify $< --design $(DESIGN) --design-units $(UNITS) --tolerance $(TOLERANCE) -q

$(MACHINING)/worn.stl: $(MACHINING)/finish.nc $(B)/bin/fettle-mill
	$(MILL_WORN)
$(MACHINING)/corrected.nc: $(MACHINING)/worn.stl $(MACHINING)/finish.nc $(B)/bin/fettle-verify
	$(VERIFY_WORN) --correct $(MACHINING)/finish.nc --cutter $(WORN) --corrected $@ --report $(MACHINING)/worn.json -o $(@D)/worn.pcd || test $$? = 1
$(MACHINING)/corrected.stl: $(MACHINING)/corrected.nc $(B)/bin/fettle-mill
	$(MILL_WORN)
$(MACHINING)/corrected.json: $(MACHINING)/corrected.stl $(B)/bin/fettle-verify
	$(VERIFY_WORN) --report $@ -o $(@D)/corrected.pcd || test $$? = 1

.DELETE_ON_ERROR:
