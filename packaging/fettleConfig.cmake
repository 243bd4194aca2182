# find_package(fettle) gives the target fettle::fettle.
include(CMakeFindDependencyMacro)
find_dependency(Eigen3)

get_filename_component(_fettle_libdir "${CMAKE_CURRENT_LIST_DIR}/../.." ABSOLUTE)
find_path(_fettle_headers core/error.h PATHS "${_fettle_libdir}/../include/fettle" "${_fettle_libdir}/../../include/fettle"
          NO_DEFAULT_PATH REQUIRED)
if(NOT TARGET fettle::fettle)
    add_library(fettle::fettle STATIC IMPORTED)
    set_target_properties(fettle::fettle PROPERTIES
        IMPORTED_LOCATION "${_fettle_libdir}/libfettle.a"
        INTERFACE_INCLUDE_DIRECTORIES "${_fettle_headers}"
        INTERFACE_COMPILE_FEATURES cxx_std_20
        INTERFACE_LINK_LIBRARIES "Eigen3::Eigen;ceres;glog;opencv_imgproc;opencv_core;png;md;urdfdom_model;console_bridge;tinyxml;lzf;tbb;minizip;expat;z")
endif()
