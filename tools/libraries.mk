# Which heavy libraries a tool links. A tool that is not listed links none of them.
$(B)/bin/fettle-place:   LDLIBS = $(PLACE)
$(B)/bin/fettle-find:    LDLIBS = $(OPENCV)
$(B)/bin/fettle-merge:   LDLIBS = $(CERES)
$(B)/bin/fettle-arm:     LDLIBS = $(URDF) $(MD)
$(B)/bin/fettle-gantry-robot: LDLIBS = $(URDF) $(MD)
$(B)/bin/fettle-collide: LDLIBS = $(OPENCV) $(PNG) $(URDF) $(MD)
$(B)/bin/fettle-fit:     LDLIBS = $(CERES)
$(B)/bin/fettle-sample:  LDLIBS = $(CERES)
$(B)/bin/fettle-render:  LDLIBS = $(OPENCV) $(PNG)
$(B)/bin/fettle-view:    LDLIBS = $(OPENCV) $(PNG)
$(B)/bin/fettle-report:  LDLIBS = $(OPENCV) $(PNG) $(MD)
$(B)/bin/fettle-station: LDLIBS = $(CERES) $(OPENCV) $(PNG) $(MD)
$(B)/bin/fettle-grind:   LDLIBS = $(OPENCV) $(PNG) $(MD)
$(B)/bin/fettle-mill:    LDLIBS = $(OPENCV) $(PNG)
$(B)/bin/fettle-manual $(B)/bin/fettle-plan $(B)/bin/fettle-teach: LDLIBS = $(MD)
$(B)/bin/fettle-calibrate: LDLIBS = -lopencv_core $(MD)
$(B)/bin/fettle-contact: LDLIBS = -lopencv_core
$(B)/bin/fettle-belt:    LDLIBS = $(OPENCV) $(PNG) $(MD)
$(B)/bin/fettle-feed:    LDLIBS = -lopencv_core
$(B)/bin/fettle-step:    LDLIBS = $(OCCT_LIBS)
# LinuxCNC's libraries are under the GPL: so is this program as a whole.
$(B)/bin/fettle-gantry-linuxcnc: LDLIBS = /usr/lib/liblinuxcnc.a -lnml -llinuxcncini -ltooldata -llinuxcnchal
