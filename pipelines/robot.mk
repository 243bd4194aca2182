# The robot: the IRB 1400 of Chen & Wei in its cell of 2 x 4 x 2 m.
#
#   make -f pipelines/robot.mk keel             from a sheet to a checked path of joints, with the robot's program
#   make -f pipelines/robot.mk reach            where it reaches: a picture of each layer, and the whole cell's numbers
#   make -f pipelines/robot.mk reach CELL=20    finer cells, mm
#
# ROBOT/keel holds the sheet, joints, program, clearances, their picture and report. ROBOT/reach/HEIGHT.png is a layer, one cell
# thick; ROBOT/reach/cell.json counts all cells of 100 mm.

B       ?= build
ROBOT   ?= $(B)/robot
CELL    ?= 50
HEIGHTS := 100 300 500 700 900 1100 1300 1500 1700 1900
ARM     := $(B)/bin/fettle-arm samples/robots/irb1400.json

.PHONY: keel reach
keel: $(ROBOT)/keel/clearance.png
	@jq -r '"\(.reached) of \(.count) poses reached, \(.collisions) collide, \(.collisions_between) ways between them; least clearance \(1000 * .least.clearance | round / 1000) mm, \(.least.pair | join(" and "))"' $(ROBOT)/keel/report.json

reach: $(HEIGHTS:%=$(ROBOT)/reach/%.png) $(ROBOT)/reach/cell.json
	@jq -r '"of \(.cells) cells \(100 * .reached | round) % are reached, \(100 * .reached_from_all_sides | round) % from all sides"' $(ROBOT)/reach/cell.json

include pipelines/step.mk

# Commas are no part of a step's command.
LAYER = 0,-1000,$*,2000,3000,$*
WHOLE = 0,-1000,0,2000,3000,2000
TITLE = Reach of the IRB 1400 on its track, z $* mm

$(ROBOT)/reach/%.pcd: $(B)/bin/fettle-arm samples/robots/irb1400.json
	$(call step,$(ARM) --reach --box $(LAYER) --step $(CELL) -o $@.part)

$(ROBOT)/reach/%.png: $(ROBOT)/reach/%.pcd $(B)/bin/fettle-render
	$(call step,$(B)/bin/fettle-render $< --field reach --title "$(TITLE)" -o $@.part)

$(ROBOT)/reach/cell.json: $(B)/bin/fettle-arm samples/robots/irb1400.json
	$(call step,$(ARM) --reach --box $(WHOLE) --report $@.part > /dev/null)

$(ROBOT)/keel/keel.stl: $(B)/bin/fettle-part samples/parts/keel.json
	$(call step,$< samples/parts/keel.json -o $@.part)

$(ROBOT)/keel/joints.pcd: samples/paths/keel.pcd $(B)/bin/fettle-arm samples/robots/irb1400.json
	$(call step,$(ARM) --inverse $< --feed 50 --rapid $(@D)/keel.mod -o $@.part)

# Exit status 1 is an answer, which the report holds.
$(ROBOT)/keel/checked.pcd: $(ROBOT)/keel/joints.pcd $(ROBOT)/keel/keel.stl $(B)/bin/fettle-collide samples/robots/irb1400.json
	$(call step,$(B)/bin/fettle-collide samples/robots/irb1400.json $< --workpiece $(@D)/keel.stl --report $(@D)/report.json -q -o $@.part || test $$? = 1)

$(ROBOT)/keel/clearance.png: $(ROBOT)/keel/checked.pcd $(B)/bin/fettle-render
	$(call step,$(B)/bin/fettle-render $< --field clearance --title "Clearance along the keel" -o $@.part)
