# What a study needs so that one variable sends it to a cluster (docs/studies.md):
#
#   make -f pipelines/factorial.mk -j2                                                             on this machine
#   make -f pipelines/factorial.mk -j100 LAUNCH='srun -Q -n1 -c1 --quit-on-interrupt'              under Slurm
#
# $(call step,COMMAND) is the recipe of a step: COMMAND writes $@.part. Wherever it runs, it takes the name $@ only when it is
# whole; and $@ is checked afterwards, because srun reports success when it has lost the node that did the work.
# COMMAND holds neither a single quote nor a comma of its own.

LAUNCH ?=

step = @mkdir -p $(@D) && rm -f $@ && $(LAUNCH) sh -c '$1 && mv $@.part $@' && test -e $@

.DELETE_ON_ERROR:
.SECONDARY:
