# The robot: the IRB 1400 of Chen & Wei in its cell of 2 x 4 x 2 m.
#
#   make -f pipelines/robot.mk keel             from a sheet to a checked path of joints, with the robot's program
#   make -f pipelines/robot.mk hulls            Chen & Wei's two hulls, milled with 1 mm step and step-over, checked and led around collisions
#   make -f pipelines/robot.mk times            how long that takes, nothing else running
#   make -f pipelines/robot.mk reach            where it reaches: a picture of each layer, and the whole cell's numbers
#   make -f pipelines/robot.mk reach CELL=20    finer cells, mm
#
# ROBOT/keel holds the sheet, joints, program, report, the clearances as a chart, and the cell at the pose where it is nearest to a collision (cell.png). ROBOT/small and ROBOT/large hold a hull each, its path, the
# path led around pose by pose and smoothly (pose.pcd, smooth.pcd) with reports and pictures, the robot's program of
# the latter, and the hull as triangles under the tool and cuboids elsewhere (model.png). ROBOT/reach/HEIGHT.png is a layer, one cell
# thick; ROBOT/reach/cell.json counts all cells of 100 mm.

B       ?= build
ROBOT   ?= $(B)/robot
CELL    ?= 50
HEIGHTS := 100 300 500 700 900 1100 1300 1500 1700 1900
ARM     := $(B)/bin/fettle-arm samples/robots/irb1400.json

.PHONY: keel reach hulls times
keel: $(ROBOT)/keel/checked.pcd $(ROBOT)/keel/keel.mod
	@jq -r '"\(.reached) of \(.count) poses reached, \(.collisions) collide, \(.collisions_between) ways between them; least clearance \(1000 * .min.clearance | round / 1000) mm, \(.min.pair | join(" and "))"' $(ROBOT)/keel/report.json

reach: $(HEIGHTS:%=$(ROBOT)/reach/%.png) $(ROBOT)/reach/cell.json
	@jq -r '"of \(.cells) cells \(100 * .reached | round) % are reached, \(100 * .reached_from_all_sides | round) % from all sides; \(1000 * .limited.by_length | round / 10) % are too far for the arm, \(1000 * .limited.by_joint_ranges | round / 10) % for its joints, \(1000 * .limited.by_collisions | round / 10) % never free of collisions"' $(ROBOT)/reach/cell.json

include pipelines/step.mk

LAYER = 0,-1000,$*,2000,3000,$*
WHOLE = 0,-1000,0,2000,3000,2000

$(ROBOT)/reach/%.pcd: $(B)/bin/fettle-arm samples/robots/irb1400.json
	$(call step,$(ARM) --reach --box $(LAYER) --step $(CELL) --report $(@:.pcd=.json) -o $@.part)

# Its headline is the finding.
$(ROBOT)/reach/%.title: $(ROBOT)/reach/%.pcd
	@jq -r '"IRB 1400 on its track, z $* mm: reaches \(100 * .reached | round) % of the places, from \(100 * .mean_reach | round) % of the sides on the mean"' $(<:.pcd=.json) > $@

$(ROBOT)/reach/%.png: $(ROBOT)/reach/%.pcd $(ROBOT)/reach/%.title $(B)/bin/fettle-render
	$(call step,$(B)/bin/fettle-render $< --field reach --scale 1 --title "$$(cat $(<:.pcd=.title))" -o $@.part)

$(ROBOT)/reach/cell.json: $(B)/bin/fettle-arm samples/robots/irb1400.json
	$(call step,$(ARM) --reach --box $(WHOLE) --report $@.part > /dev/null)

# The hull of 300 x 120 x 100 mm lies in a vise, that of 567 x 250 x 150 mm is on the table, its keel towards the robot. Both
# are finished lying along x, keel up, by a ball of 12 mm. PLACE brings them to the cell, TURN is that of the tool.
HULLS := small large
LIES  := 0.7071067811865476 0 0 0.7071067811865476
STANDS := 0.7071067811865476 0 -0.7071067811865476 0
$(ROBOT)/small/%: SIZE  := 300 120 100
$(ROBOT)/small/%: PLACE := $(LIES) 1000 850 460
$(ROBOT)/small/%: TURN  := $(LIES)
$(ROBOT)/small/%: CELL_OF := samples/robots/irb1400_vise.json
$(ROBOT)/large/%: SIZE  := 567 250 150
$(ROBOT)/large/%: PLACE := $(STANDS) 1075 1000 420
$(ROBOT)/large/%: TURN  := 0.5 0.5 -0.5 -0.5
$(ROBOT)/large/%: CELL_OF := samples/robots/irb1400_table.json
# Commas are no part of a step's command.
$(ROBOT)/small/%: FROM  := 1,-1,0.8
$(ROBOT)/large/%: FROM  := -0.3,-1,0.4
$(ROBOT)/small/%: NEAR  := 1,-1,0.5
$(ROBOT)/large/%: NEAR  := -1,-0.6,0.3
COLLIDE = $(B)/bin/fettle-collide $(CELL_OF) $(@D)/path.pcd --workpiece $(@D)/hull.stl
AVOID = $(COLLIDE) --report $(basename $@).json --picture $(basename $@).png --from $(FROM) --chart $(basename $@)-clearance.png --avoid

# Seconds by the clock, and of all processors.
times: $(foreach hull,$(HULLS),$(ROBOT)/$(hull)/pose.time $(ROBOT)/$(hull)/smooth.time)
	@tail -n 1 $^

.PHONY: $(foreach hull,$(HULLS),$(ROBOT)/$(hull)/pose.time $(ROBOT)/$(hull)/smooth.time)
$(foreach hull,$(HULLS),$(ROBOT)/$(hull)/pose.time $(ROBOT)/$(hull)/smooth.time): $(ROBOT)/%.time: $(ROBOT)/small/path.pcd $(ROBOT)/large/path.pcd $(ROBOT)/small/hull.stl $(ROBOT)/large/hull.stl
	@bash -c "TIMEFORMAT='%R s, of processors %U s'; time ($(COLLIDE) --avoid $(notdir $*) -q -o /dev/null || test \$$? = 1)" 2> $@

hulls: $(HULLS:%=$(ROBOT)/%/model.png) $(HULLS:%=$(ROBOT)/%/checked.pcd) $(HULLS:%=$(ROBOT)/%/pose.pcd) $(HULLS:%=$(ROBOT)/%/smooth.pcd) $(HULLS:%=$(ROBOT)/%/hull.mod)
	@pipelines/robot-table $(HULLS:%=$(ROBOT)/%)

$(ROBOT)/%/lying.stl: samples/designs/bestboat.stl pipelines/robot-hull
	$(call step,pipelines/robot-hull mesh $(SIZE) < $< > $@.part)

$(ROBOT)/%/points.pcd: $(ROBOT)/%/lying.stl $(B)/bin/fettle-finish
	$(call step,$(B)/bin/fettle-finish $< --cutter ball:12 --step-over 1 --pcd --ascii -o $@.part)

$(ROBOT)/%/hull.stl: $(ROBOT)/%/lying.stl pipelines/robot-hull
	$(call step,pipelines/robot-hull place $(PLACE) < $< > $@.part)

$(ROBOT)/%/path.pcd: $(ROBOT)/%/points.pcd pipelines/robot-hull
	$(call step,pipelines/robot-hull place $(PLACE) < $< | pipelines/robot-hull poses 1 10 $(TURN) > $@.part)

$(ROBOT)/%/checked.pcd: $(ROBOT)/%/path.pcd $(ROBOT)/%/hull.stl $(B)/bin/fettle-collide $(wildcard samples/robots/*.json)
	$(call step,$(COLLIDE) --report $(@D)/checked.json --picture $(@D)/checked.png --from $(FROM) -q -o $@.part || test $$? = 1)

$(ROBOT)/%/pose.pcd: $(ROBOT)/%/path.pcd $(ROBOT)/%/hull.stl $(B)/bin/fettle-collide $(wildcard samples/robots/*.json)
	$(call step,$(AVOID) pose -q -o $@.part || test $$? = 1)

$(ROBOT)/%/smooth.pcd: $(ROBOT)/%/path.pcd $(ROBOT)/%/hull.stl $(B)/bin/fettle-collide $(wildcard samples/robots/*.json)
	$(call step,$(AVOID) smooth -q -o $@.part || test $$? = 1)

# The workpiece as Chen & Wei's figure 6 has it, at one pose.
$(ROBOT)/%/model.png: $(ROBOT)/%/path.pcd $(ROBOT)/%/hull.stl $(B)/bin/fettle-collide $(wildcard samples/robots/*.json)
	$(call step,pipelines/robot-hull pick 30000 < $< | $(B)/bin/fettle-collide $(CELL_OF) --workpiece $(@D)/hull.stl --method grid --cell 5 --picture $@.part --from $(NEAR) -q -o /dev/null || test $$? = 1)

$(ROBOT)/%/hull.mod: $(ROBOT)/%/smooth.pcd $(B)/bin/fettle-arm
	$(call step,$(B)/bin/fettle-arm $(CELL_OF) --forward $< --feed 50 --rapid $@.part --unchecked -q -o /dev/null)

$(ROBOT)/keel/keel.stl: $(B)/bin/fettle-part samples/parts/keel.json
	$(call step,$< samples/parts/keel.json -o $@.part)

$(ROBOT)/keel/joints.pcd: samples/paths/keel.pcd $(B)/bin/fettle-arm samples/robots/irb1400.json
	$(call step,$(ARM) --inverse $< --feed 50 -o $@.part)

# Exit status 1 is an answer, which the report holds.
$(ROBOT)/keel/checked.pcd: FROM := 1,-1,0.5
$(ROBOT)/keel/checked.pcd: $(ROBOT)/keel/joints.pcd $(ROBOT)/keel/keel.stl $(B)/bin/fettle-collide samples/robots/irb1400.json
	$(call step,$(B)/bin/fettle-collide samples/robots/irb1400.json $< --workpiece $(@D)/keel.stl --report $(@D)/report.json --picture $(@D)/cell.png --from $(FROM) --chart $(@D)/clearance.png -q -o $@.part || test $$? = 1)

$(ROBOT)/keel/keel.mod: $(ROBOT)/keel/checked.pcd $(B)/bin/fettle-arm
	$(call step,$(ARM) --forward $< --feed 50 --rapid $@.part -q -o /dev/null)
