# Real scans registered to their design from any start: three scans of a steel part by a robot-held lidar, 100 random starts each.
#
#   make -f pipelines/align.mk -j2 DATA=FOLDER           the table; exit 1 if a figure is missed
#   make -f pipelines/align.mk -j2 DATA=FOLDER STARTS=10 fewer starts
#
# FOLDER holds shape1_10000.pcd, the design, and shape1_{0,60,90}deg_filtered.pcd, the scans, from
# github.com/thillRobot/seam_detection (pcd_images/shape1_shape2); they are under the GPL and so not part of fettle.
# ALIGN/SCAN/START.json is the report of one registration.

B      ?= build
STARTS ?= 100
ALIGN  ?= $(B)/align
SCANS  := 0deg 60deg 90deg
UNITS  := --file-units m --to-units m
DESIGN  = $(DATA)/shape1_10000.pcd
START_NUMBERS := $(shell seq $(STARTS))

.PHONY: align
align: $(foreach scan,$(SCANS),$(START_NUMBERS:%=$(ALIGN)/$(scan)/%.json))
	@pipelines/align-table $(ALIGN) $(STARTS) $(SCANS)

include pipelines/step.mk

ifndef DATA
$(error DATA=FOLDER must say where the scans are: see pipelines/align.mk)
endif

# A random start moves the scan; exit status 1, not converged, is for the table to count.
define scan_rule
$(ALIGN)/$(1)/%.json: $(B)/bin/fettle-align pipelines/random-transform
	$$(call step,pipelines/random-transform $$* 1 > $$@.T && \
	    $$< $(DATA)/shape1_$(1)_filtered.pcd $(UNITS) --to $(DESIGN) --transform-in $$@.T --iterations 0 -q | \
	    $$< $(UNITS) --to $(DESIGN) --max-distance 0.006 --report $$@.part -q > $$@.aligned || test $$$$? = 1; \
	    rm -f $$@.T $$@.aligned)
endef
$(foreach scan,$(SCANS),$(eval $(call scan_rule,$(scan))))
