#include "cli/version.h"

#include <ceres/version.h>
#include <CLI/Version.hpp>
#include <Eigen/Core>
#include <link.h>
#include <nlohmann/json_fwd.hpp>
#include <opencv2/core/version.hpp>
#include <tbb/version.h>

#include <string>
#include <string_view>

#define FETTLE_TEXT_OF(number) #number
#define FETTLE_TEXT(number) FETTLE_TEXT_OF(number)
#define FETTLE_VERSION_TEXT(a, b, c) FETTLE_TEXT(a) "." FETTLE_TEXT(b) "." FETTLE_TEXT(c)

namespace fettle::cli {

namespace {

/// File of a shared library that this program is linked with, "libtbb.so.12"; empty if it is not.
/// @param name  of the file, up to the first dot
std::string linked_file(std::string_view name)
{
    struct Search {
        std::string_view name;
        std::string found;
    } search{name, {}};
    const auto matches = [](dl_phdr_info* library, std::size_t, void* data) {
        Search& wanted = *static_cast<Search*>(data);
        const std::string_view path = library->dlpi_name;
        const std::string_view file = path.substr(path.rfind('/') + 1);
        if (file.substr(0, file.find('.')) != wanted.name) return 0;
        wanted.found = file;
        return 1;
    };
    dl_iterate_phdr(matches, &search);
    return search.found;
}

bool is_linked(std::string_view name) { return !linked_file(name).empty(); }

/// The version in the name of a shared library's file: "1.13" of "libpcl_common.so.1.13".
std::string version_of(const std::string& file)
{
    constexpr std::string_view kBefore = ".so.";
    const std::size_t at = file.find(kBefore);
    return at == std::string::npos ? "" : file.substr(at + kBefore.size());
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
    // Its headers are not at hand where only the demonstration is built.
    if (const std::string file = linked_file("libpcl_common"); !file.empty()) text += ", PCL " + version_of(file);
    if (is_linked("libtbb")) text += ", oneTBB " TBB_VERSION_STRING;
    return text;
}

} // namespace fettle::cli
