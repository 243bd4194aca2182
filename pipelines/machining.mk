# A design machined virtually and judged: path, machined part, data sheet, picture, verdict.
#
#   make -f pipelines/machining.mk                                        the mould of samples/
#   make -f pipelines/machining.mk CUTTER=bull:25,5 SCALLOP=0.1           another cutter, finer passes
#   make -f pipelines/machining.mk DESIGN=part.stl UNITS=mm STOCK=box:…   another design
#
# MACHINING/finish.nc is the program, machined.stl the part, patches.pcd the errors of its triangles, sheet.csv the data sheet,
# errors.png the picture, verdict.json the report. fettle-verify judges by the closest point, since the mould has steep walls; what
# triangles cut off the rims of walls is no more than half a cell of the grid.

B         ?= build
MACHINING ?= $(B)/machining
DESIGN    ?= samples/designs/mould.stl
UNITS     ?= m
STOCK     ?= box:1,1,-50.8,659,659,256
CUTTER    ?= ball:25
# Ridges between passes, errors of the grid, and what is judged by, mm: the sum of the first two is within the third.
SCALLOP   ?= 0.4
GRID      ?= 0.2
TOLERANCE ?= 0.6

.PHONY: machining
machining: $(MACHINING)/errors.png $(MACHINING)/verdict.json
	@pipelines/machining-table $(MACHINING)

$(MACHINING)/finish.nc: $(DESIGN) $(B)/bin/fettle-finish
	@mkdir -p $(@D)
	$(B)/bin/fettle-finish $< --file-units $(UNITS) --cutter $(CUTTER) --scallop $(SCALLOP) -o $@

# Exit status 1 of the judges is an answer, which the table tells.
$(MACHINING)/machined.stl: $(MACHINING)/finish.nc $(DESIGN) $(B)/bin/fettle-mill
	$(B)/bin/fettle-mill $< --stock $(STOCK) --cutter $(CUTTER) --tolerance $(GRID) --design $(DESIGN) --design-units $(UNITS) \
	    --report $(@D)/machined.json -o $@ || test $$? = 1

$(MACHINING)/patches.pcd: $(MACHINING)/machined.stl $(DESIGN) $(B)/bin/fettle-verify
	$(B)/bin/fettle-verify $< --design $(DESIGN) --design-units $(UNITS) --tolerance $(TOLERANCE) --method closest -q \
	    --csv $(@D)/sheet.csv --z-errors $(@D)/z-errors.pcd --report $(@D)/verdict.json -o $@ || test $$? = 1
$(MACHINING)/verdict.json: $(MACHINING)/patches.pcd

$(MACHINING)/errors.png: $(MACHINING)/patches.pcd $(B)/bin/fettle-render
	$(B)/bin/fettle-render $< --scale $(TOLERANCE) --from 1,-1,2 --title 'material left after finishing' -o $@

.DELETE_ON_ERROR:
