# Raw scans in, verdict out: a part is cleaned, its anomalies are found, and each is ground by a job of its own. Nobody marks anything.
#
#   make -f pipelines/raw.mk demo                             the hammer with its bead and burr
#   make -f pipelines/raw.mk part PART=SCAN TEMPLATE=JOB      a scan of yours; JOB has the machine's values. PART='SCAN SCAN …' are put together
#       NAME=part                  a folder of its own in $(RAW)
#       UNITS=mm                   of SCAN, if it states none
#       CLEAN=no                   SCAN, in mm, is clean
#       FIND='--keep 3 --drop 1'   what a person decided about doubtful rows
#       LIMIT=0.4                  the verdict: within ± this of it, mm; without it, JOB's tolerance
#       TRUTH=FILE                 what the ground surface is judged against; without it, the surface that was fitted
#
# In $(RAW)/NAME: found.json, jobs/ROW.json, and for each row a folder with found.png and its page report.html; at last a table.

B   ?= build
RAW ?= $(B)/raw
export PATH := $(abspath $(B)/bin):$(PATH)

NAME     ?= part
UNITS    ?= mm
TEMPLATE ?= samples/jobs/hammer.json
FIND     ?=
TRUTH    ?=
LIMIT    ?=
CLEAN    ?= yes
NOISE    ?= normal:$(shell jq .probe.accuracy $(TEMPLATE))
D        := $(RAW)/$(NAME)
part_in   = $(if $(filter no,$(CLEAN)),$(PART),$D/clean.ply)
ROWS     := $(patsubst $D/jobs/%.json,%,$(wildcard $D/jobs/*.json))

.DELETE_ON_ERROR:
.SECONDARY:
.PHONY: demo part ground table

part: $D/found.json
	@$(MAKE) --no-print-directory -f pipelines/raw.mk ground NAME=$(NAME) PART="$(PART)" CLEAN=$(CLEAN) TEMPLATE=$(TEMPLATE) TRUTH=$(TRUTH) LIMIT=$(LIMIT)

ground: $(ROWS:%=$D/%/report.html) $(ROWS:%=$D/%/found.png)
	@pipelines/raw-table $D

# --- what is found ------------------------------------------------------------------------------------------------------
# A mesh stays one: its vertices are no outliers of each other.
# A scan that fits nowhere (exit 1) is named, and left out.
$D/merged.pcd: $(PART) $(B)/bin/fettle-merge
	@mkdir -p $D
	fettle-merge $(PART) --file-units $(UNITS) --report $D/poses.json -o $@ || test $$? -eq 1

$D/clean.ply: $(if $(word 2,$(PART)),$D/merged.pcd,$(PART)) $(B)/bin/fettle-clean $(B)/bin/fettle-place
	@mkdir -p $D
	fettle-place $< --file-units $(UNITS) --units mm --format ply | fettle-clean - -o $@

# Exit 1: rows that a person must decide about have no job; the table names them.
$D/found.json: $(part_in) $(TEMPLATE) $(B)/bin/fettle-find
	@mkdir -p $D && rm -rf $D/jobs
	fettle-find $< --file-units mm --jobs $D/jobs --template $(TEMPLATE) $(FIND) --report $@ -o $D/found.pcd || test $$? -eq 1

# The part as the job sees it.
$D/%/found.png: $D/jobs/%.json $D/found.json $(B)/bin/fettle-render
	@mkdir -p $(@D)
	fettle-render $D/found.pcd --field height --within $< -o $@ \
	    --title "$(NAME), row $*: up to $$(jq --argjson row $* '.anomalies[] | select(.anomaly == $$row).height * 100 | round / 100' $D/found.json) mm over the surface beneath"

# --- each row ------------------------------------------------------------------------------------------------------------
$D/%/samples.pcd: $D/jobs/%.json $(part_in) $(B)/bin/fettle-sample
	@mkdir -p $(@D)
	fettle-sample $< --on $(part_in) --noise $(NOISE) --seed 1 --report $(@D)/sample.json -o $@

# What the scan shows of the metal's waves the margin of a free-form surface takes in; a plane has none.
scan_of_job = $$(jq -r 'if (.surface.type // "freeform") == "freeform" then "--scan $(part_in)" else "" end' $<)
$D/%/desired.json: $D/jobs/%.json $D/%/samples.pcd $(part_in) $(B)/bin/fettle-fit $(B)/bin/fettle-margin
	fettle-fit $< $(@D)/samples.pcd | fettle-margin $< $(scan_of_job) -o $@

$D/%/plan.json: $D/jobs/%.json $D/%/desired.json $(B)/bin/fettle-plan
	fettle-plan $< $(@D)/desired.json -o $@

$D/%/ground.pcd: $D/%/plan.json $(part_in) $(B)/bin/fettle-grind
	fettle-grind $< --stock $(part_in) --trace $(@D)/trace.pcd --report $(@D)/grind.json -o $@

$D/%/wanted.stl: $D/jobs/%.json $D/%/desired.json $(B)/bin/fettle-mesh
	fettle-mesh $(@D)/desired.json --within $< --step 0.5 --stl -o $@

$D/%/errors.pcd: $D/jobs/%.json $D/%/ground.pcd $(or $(TRUTH),$D/%/wanted.stl) $(B)/bin/fettle-compare
	fettle-compare $(@D)/ground.pcd --to $(or $(TRUTH),$(@D)/wanted.stl) --within $< -q $(LIMIT:%=--tolerance %) --report $(@D)/errors.json -o $@ || test $$? -eq 1

$D/%/report.html: $D/jobs/%.json $D/%/errors.pcd $(B)/bin/fettle-report
	fettle-report --title "$(NAME), row $*" --job $< --samples $(@D)/samples.pcd --surface $(@D)/desired.json --plan $(@D)/plan.json \
	    --grinding $(@D)/grind.json --trace $(@D)/trace.pcd --before $(part_in) --after $(@D)/ground.pcd \
	    --errors $(@D)/errors.pcd --comparison $(@D)/errors.json --report $(@D)/page.json -o $@

# --- the demonstration ----------------------------------------------------------------------------------------------------
$(RAW)/hammer.stl: samples/parts/hammer.json $(B)/bin/fettle-part
	@mkdir -p $(@D)
	fettle-part $< -o $@

$(RAW)/hammer-truth.stl: samples/parts/hammer.json $(B)/bin/fettle-part
	@mkdir -p $(@D)
	fettle-part $< --without-anomaly -o $@

demo: $(RAW)/hammer.stl $(RAW)/hammer-truth.stl
	@$(MAKE) --no-print-directory -f pipelines/raw.mk part NAME=hammer CLEAN=no PART=$(RAW)/hammer.stl TEMPLATE=samples/jobs/hammer.json TRUTH=$(RAW)/hammer-truth.stl LIMIT=0.4 FIND="--min-height 0.2"
