// Small texts: XYZ points, those of a profiler with its profiles, PTX scans, points that were picked in a viewer,
// transforms, and what the operator's stick did.

#include "align/rigid.h"
#include "cloud/profiles.h"
#include "cloud/ptx.h"
#include "cloud/xyz.h"
#include "job/picked.h"
#include "memory_file.h"
#include "reconstruct/ordered.h"
#include "strategy/steering.h"

#include <algorithm>
#include <functional>
#include <optional>
#include <sstream>
#include <vector>

using namespace fettle;

namespace {

void check_transform(const std::string& path)
{
    static fuzz::MemoryFile again;
    Eigen::Matrix4d matrix;
    if (!fuzz::is_read([&] { matrix = align::read_transform(path); })) return;
    std::ostringstream out;
    align::write_transform(out, matrix);
    fuzz::require(align::read_transform(again.with(out.str())) == matrix, "a transform reads the same again");
}

void check_steering(const std::string& path)
{
    fuzz::is_read([&] {
        strategy::Steering steering(path);
        double time = 0;
        while (!steering.at(time).end) time = std::max(time, steering.next_change().value_or(time));
    });
}

/// In the list of a page of fettle-view --pick, each corner is one of B or of S; without such a label, of both.
void check_corners(std::string_view text)
{
    const auto count = [&](char boundary) {
        Eigen::Index points = 0;
        fuzz::is_read([&] { points = job::parse_picked_points(text, "file", {boundary, true}).cols(); });
        return points;
    };
    const Eigen::Index all = count(0), of_B = count('B'), of_S = count('S');
    fuzz::require(of_B <= all && of_S <= all && of_B + of_S >= all, "each corner belongs to a boundary");
    if (all > 0 && job::holds_both_boundaries(text)) fuzz::require(of_B > 0 && of_S > 0, "both have corners");
}

/// The profiles of points hold each of them once, and the triangles between them no other.
void check_profiles(std::string_view text)
{
    cloud::Cloud cloud;
    if (!fuzz::is_read([&] { cloud = cloud::parse_xyz(text, "file"); }) || !cloud.xyz.allFinite()) return;
    const std::optional<cloud::Profiles> profiles = cloud::find_profiles(cloud.xyz);
    if (!profiles) return;
    const std::vector<Eigen::Index>& first = profiles->first;
    fuzz::require(first.front() == 0 && first.back() == cloud.size() &&
                      std::ranges::adjacent_find(first, std::greater_equal()) == first.end(),
                  "each point belongs to one profile");
    for (const Eigen::Vector3i& corners : reconstruct::profile_triangles(cloud.xyz, *profiles).triangles)
        fuzz::require(corners.minCoeff() >= 0 && corners.maxCoeff() < cloud.size(), "a triangle's corners are points");
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    static fuzz::MemoryFile memory;
    const std::string_view text = fuzz::text_of(data, size);
    check_profiles(text);
    fuzz::is_read([&] { cloud::parse_ptx(text, "file"); });
    fuzz::is_read([&] { job::parse_picked_points(text, "file"); });
    check_corners(text);
    const std::string& path = memory.with(text);
    check_transform(path);
    check_steering(path);
    return 0;
}
