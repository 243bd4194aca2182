#include "cli/version.h"

#include <ceres/version.h>
#include <CLI/Version.hpp>
#include <Eigen/Core>
#include <link.h>
#include <nlohmann/json_fwd.hpp>
#include <opencv2/core/version.hpp>
#include <tbb/version.h>

#include <string_view>

#define FETTLE_TEXT_OF(number) #number
#define FETTLE_TEXT(number) FETTLE_TEXT_OF(number)
#define FETTLE_VERSION_TEXT(a, b, c) FETTLE_TEXT(a) "." FETTLE_TEXT(b) "." FETTLE_TEXT(c)

namespace fettle::cli {

namespace {

/// Whether this program is linked with a shared library. @param name  its file's, up to the first dot
bool is_linked(std::string_view name)
{
    const auto matches = [](dl_phdr_info* library, std::size_t, void* wanted) {
        const std::string_view path = library->dlpi_name;
        const std::string_view file = path.substr(path.rfind('/') + 1);
        return file.substr(0, file.find('.')) == *static_cast<std::string_view*>(wanted) ? 1 : 0;
    };
    return dl_iterate_phdr(matches, &name) != 0;
}

} // namespace

std::string describe_build()
{
#ifdef __clang__
    std::string text = __VERSION__;
#else
    std::string text = "GCC " __VERSION__;
#endif
    text += "; CLI11 " CLI11_VERSION;
    text += ", Eigen " FETTLE_VERSION_TEXT(EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION);
    text += ", JSON for Modern C++ " FETTLE_VERSION_TEXT(NLOHMANN_JSON_VERSION_MAJOR, NLOHMANN_JSON_VERSION_MINOR,
                                                         NLOHMANN_JSON_VERSION_PATCH);
    if (is_linked("libceres")) text += ", Ceres " CERES_VERSION_STRING;
    if (is_linked("libopencv_core")) text += ", OpenCV " CV_VERSION;
    if (is_linked("libtbb")) text += ", oneTBB " TBB_VERSION_STRING;
    return text;
}

} // namespace fettle::cli
