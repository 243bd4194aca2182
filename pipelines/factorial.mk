# The factorial experiment of Wang 2007, 4.5, by every method of fit: anomalies of 5 widths x 5 lengths, 5 farthest
# sampling distances, 21 curvatures, cylinders, spheres and saddles: 10,500 cells, touches 99 % within 0.005 in.
#
#   make -f pipelines/factorial.mk -j2              tables and figure 4-14; exit 1 if a figure is missed
#   make -f pipelines/factorial.mk -j2 EVERY=12     every 12th cell of a batch only
#   make -f pipelines/factorial.mk -j100 LAUNCH='srun -Q -n1 -c1 --quit-on-interrupt'
#
# A step is a batch: the 125 cells of one surface and radius (in inches). FACTORIAL/SURFACE/RADIUS.json holds their errors,
# factorial.json all of them, factorial.csv the same as a table.

B         ?= build
EVERY     ?= 1
FACTORIAL ?= $(B)/factorial/every-$(EVERY)
SURFACES  ?= cylinder sphere-convex sphere-concave saddle
RADII     ?= $(shell seq 25 10 225)

BATCHES := $(foreach surface,$(SURFACES),$(RADII:%=$(FACTORIAL)/$(surface)/%.json))
CHARTS  := $(SURFACES:%=$(FACTORIAL)/figure-4-14-%.png)

.PHONY: factorial batches
factorial: $(FACTORIAL)/factorial.json $(FACTORIAL)/factorial.csv $(CHARTS)
	@$(B)/study/factorial-table $<
	@echo "cells: $(FACTORIAL)/factorial.csv   pictures: $(CHARTS)"

batches: $(BATCHES)

include pipelines/step.mk

# One thread: the step was given one processor.
$(BATCHES): $(FACTORIAL)/%.json: $(B)/study/factorial
	$(call step,$< $(subst /, ,$*) --every $(EVERY) --threads 1 -o $@.part)

$(FACTORIAL)/factorial.json: $(BATCHES)
	@jq -c -s '.[0] + {cells: map(.cells[])}' $^ > $@

$(FACTORIAL)/factorial.csv: $(FACTORIAL)/factorial.json
	@pipelines/factorial-csv $< > $@

$(FACTORIAL)/figure-4-14-%.png: $(FACTORIAL)/factorial.json $(B)/study/factorial-chart
	@$(B)/study/factorial-chart $* $< -o $@
