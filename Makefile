# fettle: a suite of small tools. One executable for each tools/fettle-NAME.cc, one library from lib/.
#
#   make            build                     make demo      the whole chain on the samples, with pictures
#   make fettle-fit one tool and the modules it needs
#   make test       build and run the tests   make figures   the chain's figures beside their targets
#   make test-all   with all statistical draws      make bench     benchmarks
#   make test TOOL=fettle-fit
#   make bless TOOL=fettle-fit                make docs      pages of docs/tools from --help, modules.svg
#   make test-linuxcnc  on LinuxCNC, simulated      make fuzz     build the fuzzing targets
#   make test-browser   pages in headless Chromium
#   make test-cad   fettle-step, with OpenCASCADE, which it installs
#   make lint       format and scripts        make includes   every file by its own includes
#   make install PREFIX=/usr/local DESTDIR=
#
# `make test` and `make demo` need nothing but git and make beforehand: they install what packages.txt names.
# B is the build folder.

VERSION  := $(shell sed -n 's/^## \([0-9.]*\).*/\1/p' CHANGELOG.md | head -n 1)
B        ?= build
PREFIX   ?= /usr/local
# No -g: -g1 takes a twentieth longer, all of -g a third, and makes objects ten times as large. Who debugs says
# CXXFLAGS="-Og -g". -DNDEBUG: Eigen's checks of sizes and indices take a fifth of the compile time; coverage, sanitizers and
# fuzzing keep them.
CXXFLAGS ?= -O2 -DNDEBUG
JOBS     ?= $(shell nproc)

# What needs LinuxCNC's headers (linuxcnc-uspace-dev) is built where they are.
LINUXCNC := $(wildcard /usr/include/linuxcnc/emc_nml.hh)
NEEDS_LINUXCNC := $(if $(LINUXCNC),,tools/fettle-gantry-linuxcnc.cc lib/gantry/linuxcnc.cc lib/gantry/linuxcnc_touch.cc lib/gantry/linuxcnc_link.cc)
# What needs OpenCASCADE (packages-cad.txt), likewise.
OCCT     := $(wildcard /usr/include/opencascade/STEPCAFControl_Reader.hxx)
NEEDS_OCCT := $(if $(OCCT),,tools/fettle-step.cc tests/lib/cad_test.cc $(wildcard lib/cad/*.cc))
LEFT_OUT := $(NEEDS_LINUXCNC) $(NEEDS_OCCT)
TOOLS    := $(patsubst tools/%.cc,%,$(filter-out $(LEFT_OUT),$(wildcard tools/fettle-*.cc)))
BINARIES := $(TOOLS:%=$(B)/bin/%)
# The command that lists them.
LIST     := $(B)/bin/fettle
TESTS    := $(patsubst tests/lib/%.cc,$(B)/tests/%,$(filter-out $(LEFT_OUT),$(wildcard tests/lib/*_test.cc)))
STUDIES  := $(patsubst pipelines/programs/%.cc,$(B)/study/%,$(wildcard pipelines/programs/*.cc))
BENCHES  := $(patsubst tests/bench/%.cc,$(B)/bench/%,$(wildcard tests/bench/*_bench.cc))
# Those of tests/linuxcnc have a machine of their own to start, those of tests/browser a browser: make test-linuxcnc, test-browser.
CASES    := $(sort $(filter-out tests/linuxcnc/% tests/browser/% $(if $(OCCT),,tests/fettle-step/%),$(wildcard tests/$(or $(TOOL),*)/*.sh)))
PROGRAMS := $(TOOLS:%=tools/%.cc) $(TESTS:$(B)/tests/%=tests/lib/%.cc) $(wildcard tests/bench/*_bench.cc pipelines/programs/*.cc)
MODULES  := $(if $(LINUXCNC),$(B)/linuxcnc/fettle_head.so $(B)/linuxcnc/fettle_press.so $(B)/linuxcnc/fettle_watch.so)

# -ffp-contract=off: the same digits on every processor. No -march: Debian's PCL is built without it, and Eigen's
# alignment must agree with PCL's.
override CXXFLAGS += -std=c++20 -Wall -Wextra -Wshadow -ffp-contract=off
# What a program does not call is left out of it, and with it the libraries that only that needs, though it was compiled
# together with what it does call.
override CXXFLAGS += -ffunction-sections -fdata-sections
# A compiler that may keep 800 MB does not stop to collect: a tenth faster.
override CXXFLAGS += $(if $(findstring clang,$(CXX)),,--param ggc-min-heapsize=800000)
override CPPFLAGS += -Ilib $(addprefix -isystem ,$(wildcard /usr/include/pcl-1.*) /usr/include/eigen3) \
                     -DFETTLE_VERSION='"$(VERSION)"'
# gold links in half the time.
override LDFLAGS  += -Wl,--as-needed,--gc-sections -fuse-ld=gold

# What most files include is read once: a third of the compile time. `make PRECOMPILED=` builds without, each file from
# its own includes alone.
PRECOMPILED ?= $(B)/lib/precompiled.h.gch $(B)/tests/lib/precompiled.h.gch
# So many files of a module, and of its tests, are compiled as one: a third of the compile time. Who works on the library says
# BUNDLE=1, and waits for the one file alone.
BUNDLE ?= 8

.DELETE_ON_ERROR:
.SECONDARY:
.PHONY: fettle $(TOOLS) all build deps coverage test test-all test-ready test-linuxcnc test-browser test-cad tests-built run-cases demo figures bench bless docs lint includes install clean

all: deps
	@$(MAKE) --no-print-directory -j$(JOBS) build

build: $(BINARIES) $(LIST) $(STUDIES) $(MODULES)

fettle $(TOOLS): %: $(B)/bin/%

# --- libraries, tool by tool: a heavy one is linked only where it is named ------------------------------------------
CERES  := -lceres -lglog
EMBREE := -lembree3
OPENCV := -lopencv_imgproc -lopencv_core
PNG    := -lpng
MD     := -lmd
FCL    := -lfcl -lccd
URDF   := -lurdfdom_model -lconsole_bridge -ltinyxml
PCL    := -lpcl_kdtree -lpcl_common
# Segmentation needs more of PCL.
PLACE  := $(PCL) -lpcl_sample_consensus -lpcl_search
# OpenCASCADE: readers with names and colours, triangulation, sewing, and what these call.
OCCT_LIBS := $(addprefix -lTK,XDESTEP XDEIGES XCAF IGES STEP STEPBase STEPAttr XSBase LCAF CAF CDF Mesh ShHealing TopAlgo GeomAlgo BRep GeomBase G3d G2d Math ernel)
LDLIBS_ALL := -llzf -ltbb -lminizip -lexpat -lz

# The files that see OpenCV. Private: what a file needs before it, the precompiled header, is compiled as ever.
$(B)/lib/draw/canvas.o $(B)/lib/belt/%.o $(B)/lib/cli/version.o $(B)/lib/find/%.o $(B)/tests/lib/%.o $(patsubst %,$(B)/pipelines/programs/find-%.o,case evidence jobs score): private override CPPFLAGS += $(addprefix -isystem ,$(wildcard /usr/include/opencv4))

# Those that see OpenCASCADE.
$(B)/lib/cad/%.o $(B)/tests/lib/%.o: private override CPPFLAGS += -isystem /usr/include/opencascade

$(B)/tests/lib/bundle-%.o: private override CPPFLAGS += -Itests/lib
# In so much code gcc loses sight of what has been initialised.
$(B)/tests/lib/bundle-%.o: private override CXXFLAGS += -Wno-maybe-uninitialized

# Square roots of eight numbers at once are one instruction where nobody reads errno.
$(B)/lib/mesh/mesh_index.o $(B)/lib/robot/workpiece_search.o $(B)/lib/robot/mesh_clearance.o: private override CXXFLAGS += -fno-math-errno
# What this one computes in float only bounds what double measures elsewhere: products and sums may be fused.
$(B)/lib/mesh/mesh_index.o: private override CXXFLAGS += -ffp-contract=fast
# Those with flags of their own are compiled alone, and so are LinuxCNC's.
ALONE := lib/mesh/mesh_index.cc lib/robot/workpiece_search.cc lib/robot/mesh_clearance.cc $(wildcard lib/gantry/linuxcnc*.cc)

# What these do themselves is little, and what they do is bound by files and people: they are sooner compiled and run so
# than with -O2.
$(B)/tests/lib/% $(B)/tools/% $(B)/pipelines/programs/%: private override CXXFLAGS += -O1
$(foreach module,cli diff draw job json part report station units,$(B)/lib/$(module)/%): private override CXXFLAGS += -O1

# As gcc lets a large unit grow by little, it would inline less of a bundle than of its files: GJK took 1.2 times as long.
$(B)/lib/robot/%: private override CXXFLAGS += $(if $(findstring clang,$(CXX)),,--param=large-unit-insns=1000000)

include tools/libraries.mk

# --- archives, module by module: a program links, and so makes, only the modules that it includes -------------------
SOURCES := $(filter-out $(LEFT_OUT),$(wildcard lib/*/*.cc))
ifneq ($(filter clean,$(MAKECMDGOALS)),clean)
include $(B)/archives.mk
endif
$(B)/archives.mk: lib/archives Makefile $(wildcard lib/*/*.h) $(SOURCES) $(PROGRAMS)
	@mkdir -p $(@D)
	@ALONE="$(ALONE)" LEFT_OUT="$(LEFT_OUT)" lib/archives $(B) $(BUNDLE) $(PROGRAMS) > $@

ARCHIVES := $(patsubst lib/%,$(B)/lib/%.a,$(filter-out %.h,$(wildcard lib/*)))
.SECONDEXPANSION:
# The archives of a program, by its source without .cc.
archives = $(patsubst %,$(B)/lib/%.a,$(MODULES_$(1)))

$(B)/lib/%.a: $$(OBJECTS_$$*)
	@rm -f $@
	$(AR) rcs $@ $^

# --- the script of pages that can be turned, as text in the program: without comments and indentation ------------------
VIEW_SCRIPTS := $(patsubst %,lib/view/%.js,decode camera renderer overlay pick section view main)
VIEW_HEADER  := $(B)/generated/view/view_script.h
$(VIEW_HEADER): $(VIEW_SCRIPTS) Makefile
	@mkdir -p $(@D)
	@{ echo 'inline constexpr char kViewScript[] = R"js('; sed -e 's/^ *//' -e '/^\/\//d' -e '/^$$/d' $(VIEW_SCRIPTS); echo ')js";'; } > $@
$(OBJECTS_view): private override CPPFLAGS += -I$(B)/generated
$(OBJECTS_view): | $(VIEW_HEADER)

# --- rules ----------------------------------------------------------------------------------------------------------
precompiled = $(filter $(B)/$(if $(findstring tests/lib/,$(1)),tests/)lib/%,$(PRECOMPILED))

$(patsubst %,$(B)/tests/lib/%.o,main $(foreach test,$(TESTS:$(B)/tests/%=%),$(PROGRAM_$(test)))): | $(filter $(B)/tests/%,$(PRECOMPILED))
define compile
	@mkdir -p $(@D)
	$(CXX) $(CPPFLAGS) $(CXXFLAGS) $(addprefix -include ,$(basename $(call precompiled,$<))) -MMD -MP -c $< -o $@
endef
$(B)/%.o: %.cc | $(filter $(B)/lib/%,$(PRECOMPILED))
	$(compile)
# The compiler takes the files of a bundle for headers, whose anonymous namespaces it would warn of.
$(B)/%.o: $(B)/%.cc | $(filter $(B)/lib/%,$(PRECOMPILED))
	$(compile) -Wno-subobject-linkage

# The copy of the header is what the compiler reads for the few files whose options differ.
$(B)/%.h.gch: %.h
	@mkdir -p $(@D)
	@cp $< $(basename $@)
	$(CXX) $(CPPFLAGS) $(CXXFLAGS) -MMD -MP -x c++-header -c $< -o $@

# All of them as one, for programs outside; without what needs OpenCASCADE, which those would have to link.
$(B)/libfettle.a: $(foreach module,$(filter-out cad,$(ARCHIVES:$(B)/lib/%.a=%)),$(OBJECTS_$(module)))
	@rm -f $@
	$(AR) rcs $@ $^

# How programs take memory: the linker leads their malloc() to tools/memory.cc. Sanitizers have one of their own.
MEMORY := $(if $(findstring -fsanitize,$(CXXFLAGS)),,$(B)/tools/memory.o)
$(B)/bin/% $(B)/study/% $(B)/bench/%: private override LDFLAGS += $(if $(findstring -fsanitize,$(CXXFLAGS)),,-Wl,--wrap=malloc)

$(B)/bin/%: $(B)/tools/%.o $(MEMORY) $$(call archives,tools/$$*)
	@mkdir -p $(@D)
	$(CXX) $(LDFLAGS) -o $@ $^ $(LDLIBS) $(LDLIBS_ALL)

# Its list is made of the README's table and of what the tools say with --help.
$(LIST): packaging/fettle.in packaging/tool-list packaging/about README.md CHANGELOG.md $(BINARIES)
	packaging/tool-list README.md $(BINARIES) > $(B)/tool-list
	sed -e 's|@VERSION@|$(VERSION)|' -e '/^@TOOLS@$$/{r $(B)/tool-list' -e 'd}' $< > $@
	chmod +x $@

# Programs of the studies: what would be too slow as a chain of tools for each of thousands of cells.
$(B)/study/%: LDLIBS = $(CERES) $(OPENCV) $(PNG) $(MD) $(URDF)
$(B)/study/%: $(B)/pipelines/programs/%.o $(MEMORY) $$(call archives,pipelines/programs/$$*)
	@mkdir -p $(@D)
	$(CXX) $(LDFLAGS) -o $@ $^ $(LDLIBS) $(LDLIBS_ALL)

# A test program is run by the name of each of its files, and then runs that file's tests alone (tests/lib/main.cc).
$(TESTS): $(B)/tests/%: $$(B)/tests/programs/$$(PROGRAM_$$*)
	@ln -f $< $@
$(B)/tests/programs/%: LDLIBS = $(CERES) $(OPENCV) $(PNG) $(MD) $(URDF) -lpcl_io -lpcl_filters $(PLACE) $(FCL) -lorocos-kdl $(if $(OCCT),$(OCCT_LIBS) -lTKPrim) -lgtest
$(B)/tests/programs/%: $(B)/tests/lib/%.o $(B)/tests/lib/main.o $$(call archives,tests/$$*)
	@mkdir -p $(@D)
	$(CXX) $(LDFLAGS) -o $@ $^ $(LDLIBS) $(LDLIBS_ALL)

$(B)/bench/%: LDLIBS = $(CERES) $(EMBREE) $(OPENCV) $(PNG) $(MD) $(URDF) -lbenchmark_main -lbenchmark
$(B)/bench/tool_hull_bench: LDLIBS += $(FCL)
$(B)/bench/libraries_bench: LDLIBS += $(PCL) -lflann_cpp -llz4
$(B)/bench/reconstruct_bench: LDLIBS += $(PCL) -lpcl_surface -lpcl_search
$(B)/bench/%: $(B)/tests/bench/%.o $(MEMORY) $$(call archives,tests/bench/$$*)
	@mkdir -p $(@D)
	$(CXX) $(LDFLAGS) -o $@ $^ $(LDLIBS) $(LDLIBS_ALL)

-include $(wildcard $(B)/*/*.d $(B)/*/*/*.d $(B)/*/*/*/*.d)

# --- what a machine needs --------------------------------------------------------------------------------------------
deps:
	@.ci/install-packages packages.txt

# --- LinuxCNC: its client, and the realtime module that simulates head and stock --------------------------------------
$(B)/lib/gantry/linuxcnc_link.o: override CPPFLAGS += -DULAPI -isystem /usr/include/linuxcnc

$(B)/linuxcnc/%.o: override CPPFLAGS += -DRTAPI -isystem /usr/include/linuxcnc
$(B)/linuxcnc/%.o: override CXXFLAGS += -fPIC -fvisibility=hidden
$(B)/linuxcnc/%.o: %.cc
	@mkdir -p $(@D)
	$(CXX) $(CPPFLAGS) $(CXXFLAGS) -MMD -MP -c $< -o $@

# The linker drops what the module does not call, and with it the libraries that only that needs.
$(B)/linuxcnc/fettle_head.so: $(patsubst %,$(B)/linuxcnc/%.o,tools/linuxcnc/fettle_head lib/gantry/simulated_head lib/removal/height_field lib/removal/preston lib/removal/wheel)
$(B)/linuxcnc/fettle_press.so: $(patsubst %,$(B)/linuxcnc/%.o,tools/linuxcnc/fettle_press lib/gantry/force_loop)
$(B)/linuxcnc/%.so:
	$(CXX) $(LDFLAGS) -shared -o $@ $^

$(B)/linuxcnc/fettle_watch.so: tools/linuxcnc/fettle_watch.comp
	@mkdir -p $(@D)
	cp $< $(@D) && cd $(@D) && MAKEFLAGS= halcompile --compile $(<F) > /dev/null

# --- tests: each golden case and each test program is a target of its own --------------------------------------------
CASE_RUNS := $(CASES:.sh=.case)
TEST_RUNS := $(if $(TOOL),,$(TESTS:%=%.run))
LINUXCNC_RUNS := $(patsubst %.sh,%.case,$(sort $(wildcard tests/linuxcnc/*.sh)))
BROWSER_RUNS := $(patsubst %.sh,%.case,$(sort $(wildcard tests/browser/*.sh)))
.PHONY: $(CASE_RUNS) $(TEST_RUNS) $(LINUXCNC_RUNS) $(BROWSER_RUNS)

# More at once than there are processors: some wait most of their time.
# For one tool only what its cases name is built. Statistical tests take a quarter of their draws, with test-all all of them.
test: export FETTLE_DRAWS ?= $(if $(filter test-all,$(MAKECMDGOALS)),all,few)
test-all: test
# While what only tests need is installed, the tools that do without it are built: one of two processors had nothing to do.
test: test-ready
	@rm -rf $(B)/results && mkdir -p $(B)/results
	@$(MAKE) --no-print-directory -j$$(($(JOBS) + 2)) -k -s run-cases $(TEST_RUNS) 2>/dev/null; tests/summary $(B)/results

test-ready:
	@.ci/install-packages packages.txt --for-demo
	@.ci/install-packages packages.txt $(if $(TOOL),,& $(MAKE) --no-print-directory -j$(JOBS) $(DEMO_TOOLS); status=$$?; wait $$! && exit $$status)
	@$(MAKE) --no-print-directory -j$(JOBS) $(if $(TOOL),$(call tools_named_in,$(CASES)),build tests-built)

tests-built: $(TESTS)

# Tools and studies' programs whose names stand in some files, and the list of all for its own cases.
tools_named_in = $(if $(filter tests/fettle/%,$(1)),$(LIST)) $(addprefix $(B)/bin/,$(sort $(filter $(TOOLS),$(shell grep -ohE "fettle-[a-z-]+" $(1)))))
# What `make demo` runs: these need no package beyond its own.
DEMO_TOOLS = $(call tools_named_in,pipelines/casting.mk) $(B)/bin/fettle-find
run-cases: $(CASE_RUNS)

# With OpenCASCADE there is one more tool; from then on `make test` runs its cases, too. A make of its own sees it.
test-cad: deps
	@.ci/install-packages packages-cad.txt
	@$(MAKE) --no-print-directory -j$(JOBS) $(B)/tests/cad_test
	@tests/run $(B) $(B)/tests/cad_test
	@$(MAKE) --no-print-directory test TOOL=fettle-step

# One after the other: each has a machine that wants the computer for itself.
test-linuxcnc: deps
	@.ci/install-packages packages-linuxcnc.txt
	@rm -rf $(B)/results-linuxcnc
	@$(MAKE) --no-print-directory -j$(JOBS) build
	@$(MAKE) --no-print-directory -j1 -k -s $(LINUXCNC_RUNS) 2>/dev/null; tests/summary $(B)/results-linuxcnc || \
	    [ -z "$$(find $(B)/results-linuxcnc -name '*.failed')" ] # where namespaces are not allowed all are skipped

# One after the other: frames are timed.
test-browser: deps
	@.ci/install-packages packages-browser.txt
	@rm -rf $(B)/results-browser
	@$(MAKE) --no-print-directory -j$(JOBS) $(call tools_named_in,$(wildcard tests/browser/*.sh))
	@$(MAKE) --no-print-directory -j1 -k -s $(BROWSER_RUNS) 2>/dev/null; tests/summary $(B)/results-browser

# A case during which the computer stood still is tried again, and each try takes as long as the machine works.
$(LINUXCNC_RUNS): export FETTLE_PATIENCE ?= 2
# What has a target of its own has results of its own, too: both can run at once.
$(LINUXCNC_RUNS): RESULTS = $(B)/results-linuxcnc
$(BROWSER_RUNS): RESULTS = $(B)/results-browser
$(CASE_RUNS) $(LINUXCNC_RUNS) $(BROWSER_RUNS): %.case: %.sh
	tests/run $(B) $< $(RESULTS)

$(TEST_RUNS): %.run: %
	tests/run $(B) $<

# Coverage of lib/ by the tests, in a build of its own. Four cases fail in it: its programs write profiles, and complain where they cannot.
coverage: deps
	@-$(MAKE) --no-print-directory test-all B=$(B)/coverage CXXFLAGS="-O1 -g1 --coverage" LDFLAGS=--coverage
	@tests/coverage $(B)/coverage > $(B)/coverage/report; sed '/:/,$$d' $(B)/coverage/report

bless: build
	@FETTLE_BLESS=1 $(MAKE) --no-print-directory -k -s $(CASE_RUNS) B=$(B)

include tests/fuzz/fuzz.mk

# --- the rest ---------------------------------------------------------------------------------------------------------
demo:
	@.ci/install-packages packages.txt --for-demo
	@$(MAKE) --no-print-directory -j$(JOBS) $(DEMO_TOOLS)
	@$(MAKE) --no-print-directory -j$(JOBS) -f pipelines/casting.mk B=$(B) demo
	@$(MAKE) --no-print-directory -j$(JOBS) -s -f pipelines/raw.mk B=$(B) demo

figures: all
	@$(MAKE) --no-print-directory -j$(JOBS) -f pipelines/casting.mk B=$(B) figures

bench: deps
	@$(MAKE) --no-print-directory -j$(JOBS) $(BENCHES)
	@set -e; for bench in $(BENCHES); do $$bench; done

docs: build
	@mkdir -p docs/tools
	@set -e; for tool in $(TOOLS) fettle; do tests/tool-page $(B)/bin/$$tool > docs/tools/$$tool.md; done
	@if command -v dot > /dev/null; then .ci/modules | dot -Tsvg > docs/pictures/modules.svg; \
	    else echo "docs: the picture of the modules is made where graphviz is" >&2; fi

lint:
	@.ci/lint

# Every file from its own includes alone: what is precompiled hides one that is missing.
includes: deps $(VIEW_HEADER)
	@.ci/install-packages packages-fuzz.txt
	@.ci/includes $(B)/includes $(JOBS) $$(git ls-files '*.cc' '*.h' | grep -v -e precompiled -e linuxcnc $(if $(OCCT),,-e cad/ -e fettle-step -e cad_test)) \
	    -- $(CXX) $(FUZZ_CXX) $(CPPFLAGS) -I$(B)/generated -isystem /usr/include/opencv4 -isystem /usr/include/opencascade \
	    $(filter-out -O% --param ggc-%,$(CXXFLAGS)) -Itests/lib

# --- installation: tools with manual pages and completion, and the library for other programs -------------------------
PAGES := $(TOOLS:%=$(B)/man/%.1) $(B)/man/fettle.1
LIBDIR ?= $(PREFIX)/lib

$(B)/man/%.1: $(B)/bin/% packaging/man-page packaging/about
	@mkdir -p $(@D)
	packaging/man-page $< > $@

$(B)/completion/fettle: $(BINARIES) packaging/completion
	@mkdir -p $(@D)
	packaging/completion $(BINARIES) > $@

$(B)/packaging/%: packaging/%.in
	@mkdir -p $(@D)
	sed 's|@PREFIX@|$(PREFIX)|; s|@LIBDIR@|$(patsubst $(PREFIX)/%,$${prefix}/%,$(LIBDIR))|; s|@VERSION@|$(VERSION)|' $< > $@

# For the library's own files alone: users of the others need neither OpenCASCADE's headers nor Boost's.
PRIVATE_HEADERS := precompiled.h cad/% job/boost_polygons.h
install: build $(B)/libfettle.a $(PAGES) $(B)/completion/fettle $(addprefix $(B)/packaging/,fettle.pc fettleConfigVersion.cmake)
	install -d $(addprefix $(DESTDIR)$(PREFIX)/,bin include/fettle share/man/man1 share/bash-completion/completions) \
	    $(addprefix $(DESTDIR)$(LIBDIR)/,pkgconfig cmake/fettle)
	install $(BINARIES) $(LIST) $(DESTDIR)$(PREFIX)/bin
	install -m 644 $(PAGES) $(DESTDIR)$(PREFIX)/share/man/man1
	install -m 644 $(B)/completion/fettle $(DESTDIR)$(PREFIX)/share/bash-completion/completions
	for tool in $(TOOLS); do ln -sf fettle $(DESTDIR)$(PREFIX)/share/bash-completion/completions/$$tool; done
	for header in $(filter-out $(PRIVATE_HEADERS),$(patsubst lib/%,%,$(wildcard lib/*/*.h))); do \
	    install -m 644 -D lib/$$header $(DESTDIR)$(PREFIX)/include/fettle/$$header || exit 1; done
	install -m 644 $(B)/libfettle.a $(DESTDIR)$(LIBDIR)
	install -m 644 $(B)/packaging/fettle.pc $(DESTDIR)$(LIBDIR)/pkgconfig
	install -m 644 packaging/fettleConfig.cmake $(B)/packaging/fettleConfigVersion.cmake $(DESTDIR)$(LIBDIR)/cmake/fettle

clean:
	rm -rf $(B)
