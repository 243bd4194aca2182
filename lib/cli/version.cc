#include "cli/version.h"

#include <boost/version.hpp>
#include <ceres/version.h>
#include <CLI/Version.hpp>
#include <Eigen/Core>
#include <nlohmann/json_fwd.hpp>
#include <opencv2/core/version.hpp>
#include <pcl/pcl_config.h>
#include <tbb/version.h>

#define FETTLE_TEXT_OF(number) #number
#define FETTLE_TEXT(number) FETTLE_TEXT_OF(number)
#define FETTLE_DOTTED(a, b, c) FETTLE_TEXT(a) "." FETTLE_TEXT(b) "." FETTLE_TEXT(c)

namespace fettle {

std::string built_with()
{
#ifdef __clang__
    const std::string compiler = __VERSION__;
#else
    const std::string compiler = "GCC " __VERSION__;
#endif
    return compiler +
           "; Boost " BOOST_LIB_VERSION ", Ceres " CERES_VERSION_STRING ", CLI11 " CLI11_VERSION
           ", Eigen " FETTLE_DOTTED(
               EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION,
               EIGEN_MINOR_VERSION) ", JSON for Modern C++ " FETTLE_DOTTED(NLOHMANN_JSON_VERSION_MAJOR,
                                                                           NLOHMANN_JSON_VERSION_MINOR,
                                                                           NLOHMANN_JSON_VERSION_PATCH) ", "
                                                                                                        "oneTBB"
                                                                                                        " " TBB_VERSION_STRING
                                                                                                        ", "
                                                                                                        "OpenCV"
                                                                                                        " " CV_VERSION
                                                                                                        ", "
                                                                                                        "PCL"
                                                                                                        " " PCL_VERSION_PRETTY;
}

} // namespace fettle
