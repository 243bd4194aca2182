# What fettle-find finds of what is known to be there: anomalies of seven kinds, off edges and at them, on scans, castings and designs that the
# project has; controls without any; scans bent by 1.5 mm against their design.
#
#   make -f pipelines/find.mk -j2                     the table; exit 1 if a figure is missed
#   make -f pipelines/find.mk -j2 CASES='0 c0'        fewer cases of each base
#   make -f pipelines/find.mk -j2 chain               the chain on each find by its own job and by an operator's: another table
#   make -f pipelines/find.mk -j2 calibration         how honest the probabilities are, on cases whose anomalies are faint, too: another table
#   make -f pipelines/find.mk -j2 evidence            the evidence on all candidates: what study/find-train learns weights from
#
# Case K of a base has 1 + K mod 5 anomalies, those of K mod 5 = 2 and 4 stand at edges; c0, c1, … have none; f0, f1, … six faint ones, e0, e1, … six faint ones at edges. A step is a case.
# samples/studies/find-bases.txt lists the bases; other files of the kind by BASES=FILE.

B     ?= build
CASES ?= 0 1 2 3 4 c0 c1
BASES ?= samples/studies/find-bases.txt
FIND  ?= $(B)/find
TEMPLATE ?= samples/jobs/hammer.json
export PATH := $(abspath $(B)/bin):$(abspath $(B)/study):$(PATH)

NAMES := $(shell awk '!/^\#/ && NF { print $$1 }' $(BASES))
ALL   := $(foreach name,$(NAMES),$(CASES:%=$(FIND)/$(name)_%))
# A bend needs a design, which scanned points are not.
MESHES  := $(shell awk '!/^\#/ && NF && $$5 > 0 { print $$1 }' $(BASES))
AGAINST := $(foreach name,$(MESHES),$(CASES:%=$(FIND)/$(name)_%))

WORN    := $(foreach name,$(NAMES),$(patsubst %,$(FIND)/$(name)_%,$(filter-out c%,$(CASES))))

DOUBTFUL ?= f0 f1 f2 e0 e1
# Draws of the touches' errors, of which the chain's errors are means.
DRAWS ?= 3

.PHONY: find chain calibration evidence
find: $(ALL:%=%/score.csv) $(AGAINST:%=%/against.csv)
	@pipelines/find-table $(FIND)

chain: $(WORN:%=%/chain.csv)
	@pipelines/find-chain-table $^

calibration: $(foreach name,$(NAMES),$(patsubst %,$(FIND)/$(name)_%/score.csv,$(CASES) $(DOUBTFUL))) $(B)/study/find-calibration
	@$(B)/study/find-calibration $(filter %.csv,$^)

evidence: $(ALL:%=%/evidence.csv)

include pipelines/step.mk

# NAME_K: the base's line, and the case's options.
base    = $(shell awk '$$1 == "$(firstword $(subst _, ,$1))"' $(BASES))
case    = $(lastword $(subst _, ,$1))
# Its draws' number, how many anomalies, whether they stand at edges.
draws   = $(if $(filter c%,$1),--number $(1:c%=10%),$(if $(filter f% e%,$1),--number $(patsubst e%,30%,$(1:f%=20%)) --anomalies 6 --faint $(if $(filter e%,$1),--edge),--number $1 --anomalies $(shell expr $1 % 5 + 1) $(if $(filter 2 4,$(shell expr $1 % 5)),--edge)))
options = --scale $(word 3,$(call base,$1)) --up $(word 4,$(call base,$1)) $(if $(filter 0,$(word 5,$(call base,$1))),,--cell $(word 5,$(call base,$1))) \
    --sigma $(word 6,$(call base,$1)) $(call draws,$(call case,$1))

$(FIND)/%/worn.pcd: $(B)/study/find-case $(BASES)
	@mkdir -p $(@D)
	$(B)/study/find-case $(word 2,$(call base,$*)) $(call options,$*) -q -o $@

$(FIND)/%/bent.pcd: $(B)/study/find-case $(BASES)
	@mkdir -p $(@D)
	$(B)/study/find-case $(word 2,$(call base,$*)) $(call options,$*) --bend 1.5 --design $(@D)/design.stl -q -o $@

$(FIND)/%/score.csv: $(FIND)/%/worn.pcd $(B)/study/find-score
	$(call step,$(B)/study/find-score $< -q > $@.part)

$(FIND)/%/evidence.csv: $(FIND)/%/worn.pcd $(B)/study/find-evidence
	$(call step,$(B)/study/find-evidence $< -q > $@.part)

$(FIND)/%/against.csv: $(FIND)/%/bent.pcd $(B)/study/find-score
	$(call step,$(B)/study/find-score $< --against $(@D)/design.stl -q > $@.part)

$(FIND)/%/chain.csv: $(FIND)/%/worn.pcd $(TEMPLATE) $(B)/study/find-jobs pipelines/find-chain
	$(call step,pipelines/find-chain $< $(TEMPLATE) $(@D)/chain $(DRAWS) > $@.part)
