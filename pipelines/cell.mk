# From a scan to checked robot programs: the anomalies of a part are found, each is fitted and planned as on the gantry (raw.mk), the passes
# become one path, and an IRB 1400 with a grinding wheel grinds the part where it lies in the cell.
#
#   make -f pipelines/cell.mk                 the scanned hammer with its bead and burr
#   make -f pipelines/cell.mk strategy        no program: the strategy itself grinds each anomaly on the robot, by the force that it meets, and on the gantry
#       PART=SCAN TEMPLATE=JOB                a scan of yours, in mm; JOB has the machine's values
#       ROBOT=FILE PLACE=MATRIX               the cell, its tool the job's wheel, and where the part lies in it: 4 x 4
#       CLEARANCE=15                          from stroke to stroke, mm
#       DIALECT=rapid                         or krl, ls, urscript
#
# In $(CELL): found.json and jobs/ROW.json, path.pcd in the part's frame, checked.pcd with joints and clearances, cell.png, program.mod (.src, .ls, .script), report.json. In $(CELL)/ROW/robot: what
# the strategy left of the part, ground.pcd, where the arm was, moves.pcd, and checked.json, what fettle-collide says of it.

B         ?= build
CELL      ?= $(B)/cell
PART      ?= $(CELL)/part.stl
TEMPLATE  ?= samples/jobs/hammer.json
ROBOT     ?= samples/robots/irb1400_wheel.json
PLACE     ?= samples/robots/hammer_place.txt
CLEARANCE ?= 15
DIALECT   ?= rapid
SUFFIX    := $(patsubst $(DIALECT):%,%,$(filter $(DIALECT):%,rapid:mod krl:src ls:ls urscript:script))
PROGRAM   := $(CELL)/program.$(or $(SUFFIX),$(error DIALECT=$(DIALECT): rapid, krl, ls or urscript))
export PATH := $(abspath $(B)/bin):$(PATH)
RAW_STEP  = $(MAKE) --no-print-directory -s -f pipelines/raw.mk B=$(B) RAW=$(patsubst %/,%,$(dir $(CELL))) NAME=$(notdir $(CELL)) PART=$(PART) CLEAN=no TEMPLATE=$(TEMPLATE)

.DELETE_ON_ERROR:
.SECONDARY:
.PHONY: cell strategy robot
cell: $(PROGRAM) $(CELL)/cell.png
	@pipelines/cell-table $(CELL)

$(CELL)/part.stl: samples/parts/hammer.json $(B)/bin/fettle-part
	@mkdir -p $(@D)
	fettle-part $< -o $@

$(CELL)/found.json: $(PART) $(TEMPLATE) $(B)/bin/fettle-find
	@$(RAW_STEP) $@

# The rows that have a job are known now.
$(CELL)/path.csv: $(CELL)/found.json pipelines/cell-path $(B)/bin/fettle-plan
	@$(RAW_STEP) $$(jq '.anomalies[] | select(.job != "").anomaly' $< | sed 's|.*|$(CELL)/&/plan.json|')
	pipelines/cell-path $(CELL) > $@

$(CELL)/path.pcd: $(CELL)/path.csv $(PART) $(B)/bin/fettle-path
	fettle-path $< --part $(PART) --clearance $(CLEARANCE) --spacing 2 -o $@

# Path and part to where they lie in the cell.
$(CELL)/placed.pcd: $(CELL)/path.pcd $(PLACE) $(B)/bin/fettle-place
	fettle-place $< --matrix $(PLACE) -q -o $@
$(CELL)/placed.stl: $(PART) $(PLACE) $(B)/bin/fettle-place
	fettle-place $< --matrix $(PLACE) -q -o $@

# Exit 1 is an answer, which the report and the table tell; a path that is not clear makes no program.
$(CELL)/checked.pcd: $(CELL)/placed.pcd $(CELL)/placed.stl $(ROBOT) $(B)/bin/fettle-collide
	fettle-collide $(ROBOT) $< --workpiece $(CELL)/placed.stl --report $(@D)/report.json --chart $(@D)/clearance.png -o $@ || test $$? -eq 1

$(CELL)/cell.png: $(CELL)/checked.pcd
	fettle-collide $(ROBOT) $< --workpiece $(CELL)/placed.stl --picture $@ -q -o /dev/null || test $$? -eq 1

$(PROGRAM): $(CELL)/checked.pcd $(B)/bin/fettle-arm
	fettle-arm $(ROBOT) --forward $< --feed 20 --$(DIALECT) $@ -q -o /dev/null

# --- the strategy on the robot ------------------------------------------------------------------------------------------
ROWS := $(patsubst $(CELL)/jobs/%.json,%,$(wildcard $(CELL)/jobs/*.json))

strategy: $(CELL)/found.json
	@$(MAKE) --no-print-directory -f pipelines/cell.mk robot

robot: $(ROWS:%=$(CELL)/%/robot/checked.json)
	@pipelines/cell-strategy $(CELL)

$(CELL)/%/robot/ground.pcd: $(CELL)/found.json $(PART) $(PLACE) $(ROBOT) $(B)/bin/fettle-grind $(B)/bin/fettle-gantry-robot
	@$(RAW_STEP) $(CELL)/$*/plan.json $(CELL)/$*/ground.pcd
	@mkdir -p $(@D)
	fettle-grind $(CELL)/$*/plan.json --stock $(PART) --place $(PLACE) --trace $(@D)/trace.pcd --report $(@D)/grind.json -o $(@D)/known.pcd \
	    --gantry 'exec:fettle-gantry-robot $(ROBOT) $(CELL)/$*/plan.json --stock $(PART) --moves $(@D)/moves.pcd --report $(@D)/moves.json --ground $@'

$(CELL)/%/robot/checked.json: $(CELL)/%/robot/ground.pcd $(CELL)/placed.stl $(B)/bin/fettle-collide
	fettle-collide $(ROBOT) $(@D)/moves.pcd --workpiece $(CELL)/placed.stl --report $@ -q -o /dev/null || test $$? -eq 1
