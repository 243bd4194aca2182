# Many parts: a folder of scans in; for each its anomalies are found, each is ground by a job of its own and judged; out come a JSON
# for each part and one table. What goes wrong with a part is in its row, and the others go on.
#
#   make -f pipelines/parts.mk -j2 SCANS=FOLDER TEMPLATE=JOB      scans of yours; JOB has the machine's values. Where a scan NAME.ply has a
#                                                                 job NAME.json beside it, that is ground, and nothing is searched
#   make -f pipelines/parts.mk -j2 sample COUNT=50                parts made with seeds 1 to COUNT, judged against what they were made of
#   make -f pipelines/parts.mk -j100 LAUNCH='srun -Q -n1 -c1 --quit-on-interrupt' sample     under Slurm
#       PARTS=build/parts   where everything goes: NAME/part.json, NAME/ROW/report.html, table.csv, and index.html, which links the pages
#       UNITS=mm            of the scans that state none
#       LIMIT=0.4           the verdict: within ± this, mm; without it, the job's tolerance, of the sample 0.4
#
# Exit 1 if any part is not within, or needs a person. A part whose part.json is there is not computed again.
B        ?= build
PARTS    ?= $(B)/parts
SCANS    ?=
TEMPLATE ?= samples/jobs/crown.json
UNITS    ?= mm
LIMIT    ?=
COUNT    ?= 50
include pipelines/step.mk
export B TEMPLATE UNITS LIMIT
export PATH := $(abspath $(B)/bin):$(PATH)

SUFFIXES_READ := pcd ply stl obj off 3mf e57 ptx xyz txt pcd.gz ply.gz stl.gz xyz.gz txt.gz
scans_in  = $(sort $(foreach suffix,$(SUFFIXES_READ),$(wildcard $(1)/*.$(suffix))))
# The name of a part: that of its scan without its suffixes.
name_of   = $(firstword $(subst ., ,$(notdir $(1))))
NAMES    := $(foreach scan,$(call scans_in,$(SCANS)),$(call name_of,$(scan)))
MADE     := $(patsubst %,part-%,$(shell seq -w 1 $(COUNT)))

.DELETE_ON_ERROR:
.SECONDARY:
.PHONY: all sample
all: $(NAMES:%=$(PARTS)/%/part.json) $(B)/bin/fettle-report
	$(if $(NAMES),,$(error no scans in SCANS='$(SCANS)'))
	$(call judge,$(NAMES))

sample: $(MADE:%=$(PARTS)/%/part.json) $(B)/bin/fettle-report
	$(call judge,$(MADE))

# The index of the parts' pages, if any was ground, and the table, whose exit status is the verdict.
define judge
@pages=$$(ls $(1:%=$(PARTS)/%/[0-9]*/page.json) 2> /dev/null); [ -z "$$pages" ] || fettle-report --title Parts --index $$pages -o $(PARTS)/index.html
@pipelines/parts-table $(PARTS) $(1) > $(PARTS)/table.csv; status=$$?; cat $(PARTS)/table.csv; exit $$status
endef

# A part of the sample, and what it was made of.
$(PARTS)/made/part-%.stl: pipelines/parts-spec $(B)/bin/fettle-part
	@mkdir -p $(@D)/$*
	cp samples/parts/crown_surface.json $(@D)/$*
	pipelines/parts-spec $* > $(@D)/$*/spec.json
	fettle-part $(@D)/$*/spec.json --without-anomaly -o $(@D)/$*/truth.stl
	fettle-part $(@D)/$*/spec.json -o $@

$(PARTS)/part-%/part.json: $(PARTS)/made/part-%.stl pipelines/part-run
	$(call step,LIMIT=$(or $(LIMIT),0.4) TRUTH=$(PARTS)/made/$*/truth.stl CLEAN=no pipelines/part-run $< $(@D) > $@.part)

define part_of_scan
$(PARTS)/$(call name_of,$(1))/part.json: $(1) $(TEMPLATE) pipelines/part-run
	$$(call step,pipelines/part-run $(1) $$(@D) > $$@.part)
endef
$(foreach scan,$(call scans_in,$(SCANS)),$(eval $(call part_of_scan,$(scan))))
