# Fuzzing (CONTRIBUTING.md): every tests/fuzz/TARGET.cc with libFuzzer and the sanitizers, by clang, its objects beside the others'.
FUZZ_CXX ?= clang++
FUZZ_RUNS ?= -1
FUZZ_SECONDS ?= $(if $(filter -1,$(FUZZ_RUNS)),60,0)
FUZZ_TARGETS := $(patsubst tests/fuzz/%.cc,%,$(wildcard tests/fuzz/*.cc))
# What the readers are made of: whole modules, and of the others the files that the targets call.
FUZZ_SOURCES := $(wildcard $(addprefix lib/,$(addsuffix /*.cc,core geometry units json cloud mesh job surface plan removal))) \
    $(addprefix lib/,$(addsuffix .cc,$(addprefix gantry/,protocol serve driver driver_checks driver_halt head_check child machine virtual_gantry quasi_static) \
    $(addprefix strategy/,trace trace_file run_identity steering joystick keys) align/rigid compare/comparison_report reconstruct/ordered \
    $(addprefix belt/,contact_wheel belt_journal_file assess running_error) \
    $(addprefix calibrate/,law_belief law_record trials_csv) \
    $(addprefix machining/,nc_block nc_arc nc_program nc_writer cutter_path cutter limits tilt) \
    $(addprefix part/,spec surface anomalies outline profile) $(addprefix sampling/,noise scan point_surface triangle_grid) \
    $(addprefix report/,summary_reader tool_reports) $(addprefix robot/,robot body_json mesh_body workpiece workpiece_search clearance deepest_point depth placed_solid round_solid hull_points simplex urdf urdf_model urdf_shapes srdf dh_from_axes arm arm_newton arm_parallel)))
# Not what belongs to the command line: a bundle is linked as a whole.
FUZZ_SOURCES := $(filter-out $(patsubst %.h,%.cc,$(shell grep -ls '"cli/' $(FUZZ_SOURCES) $(FUZZ_SOURCES:.cc=.h))),$(FUZZ_SOURCES))
# Compiled in bundles, as the library is.
ifneq ($(filter $(B)/fuzz/%,$(MAKECMDGOALS)),)
include $(B)/fuzz/archives.mk
endif
$(B)/fuzz/archives.mk: lib/archives Makefile tests/fuzz/fuzz.mk $(FUZZ_SOURCES)
	@mkdir -p $(@D)
	@ALONE="$(ALONE)" LEFT_OUT="$(filter-out $(FUZZ_SOURCES),$(wildcard lib/*/*.cc))" lib/archives $(B)/fuzz $(BUNDLE) | sed 's/^/FUZZ_/' > $@
FUZZ_LIBRARY = $(foreach module,$(sort $(foreach source,$(FUZZ_SOURCES),$(word 2,$(subst /, ,$(source))))),$(FUZZ_OBJECTS_$(module)))
FUZZ_FLAGS = $(filter-out -O% -DNDEBUG --param ggc-%,$(CXXFLAGS)) -O1 -fsanitize=address,undefined,float-cast-overflow -fno-sanitize-recover=all \
    -fsanitize-ignorelist=tests/fuzz/unchecked.txt -Wno-psabi -Wno-unused-const-variable

.PHONY: fuzz fuzz-run $(FUZZ_TARGETS:%=%.fuzz)

# Builds them all and has each read its seeds.
fuzz:
	@.ci/install-packages packages-fuzz.txt
	@$(MAKE) --no-print-directory -j$(JOBS) $(FUZZ_TARGETS:%=$(B)/fuzz/%)
	@set -e; for target in $(FUZZ_TARGETS); do tests/fuzz/run $(B) $$target 0; done

# So many inputs each, or so long.
fuzz-run: fuzz
	@$(MAKE) --no-print-directory -j$(JOBS) -k $(FUZZ_TARGETS:%=%.fuzz)

$(FUZZ_TARGETS:%=%.fuzz): %.fuzz: $(B)/fuzz/%
	tests/fuzz/run $(B) $* $(FUZZ_RUNS) $(FUZZ_SECONDS)

$(B)/fuzz/precompiled.h.pch: lib/precompiled.h
	@mkdir -p $(@D)
	$(FUZZ_CXX) $(CPPFLAGS) $(FUZZ_FLAGS) -fsanitize=fuzzer-no-link -fpch-instantiate-templates -MMD -MP -x c++-header -c $< -o $@

define fuzz_compile
	@mkdir -p $(@D)
	$(FUZZ_CXX) $(CPPFLAGS) $(FUZZ_FLAGS) -fsanitize=fuzzer-no-link -include-pch $(B)/fuzz/precompiled.h.pch -MMD -MP -c $< -o $@
endef
$(B)/fuzz/%.o: %.cc | $(B)/fuzz/precompiled.h.pch
	$(fuzz_compile)
$(B)/fuzz/%.o: $(B)/fuzz/%.cc | $(B)/fuzz/precompiled.h.pch
	$(fuzz_compile)

$(B)/fuzz/library.a: $(FUZZ_LIBRARY)
	@rm -f $@
	$(AR) rcs $@ $^

$(B)/fuzz/%: $(B)/fuzz/tests/fuzz/%.o $(B)/fuzz/library.a
	$(FUZZ_CXX) $(FUZZ_FLAGS) -fsanitize=fuzzer -o $@ $^ $(MD) $(URDF) $(LDLIBS_ALL)

-include $(B)/fuzz/precompiled.h.d
