# Which heavy libraries a tool links. A tool that is not listed links none of them.
KDTREE := -lpcl_kdtree -lpcl_search

$(B)/bin/fettle-part:     LDLIBS = $(PCD)
$(B)/bin/fettle-sample:   LDLIBS = $(PCD)
$(B)/bin/fettle-estimate: LDLIBS = $(PCD)
$(B)/bin/fettle-fit:      LDLIBS = $(PCD) $(CERES)
$(B)/bin/fettle-mesh:     LDLIBS = $(PCD)
$(B)/bin/fettle-grind:    LDLIBS = $(PCD) $(KDTREE) $(EMBREE)
$(B)/bin/fettle-compare:  LDLIBS = $(PCD) $(EMBREE)
$(B)/bin/fettle-form:     LDLIBS = $(PCD)
$(B)/bin/fettle-render:   LDLIBS = $(PCD) $(OPENCV)
$(B)/bin/fettle-diff:     LDLIBS = $(PCD)
