// A scan with anomalies whose truth is known, to judge fettle-find by:    find-case BASE --number K --anomalies N -o
// worn.pcd
//
// BASE, a mesh or a cloud, is seen from --up; a mesh is sampled at the cells of a grid as a scanner would, a cloud
// keeps its own points and noise. Up to N anomalies of the seven kinds of fettle-part stand on its smooth places, away
// from edges or (--edge) over them, high or (--faint) low; their kinds, sizes and places follow from --number alone.
// Then come the scanner's faults: white noise and half as much that is correlated over three cells, flying points,
// dropouts, faces steeper than 78° that are hardly seen. Out: PCD with the fields `truth` (0, or the number of the
// anomaly that a point is on) and `truth_height` (of that anomaly, mm).
#include "core/direction.h"
#include "find-case-anomalies.h"
#include "find-case-scanner.h"

#include "cli/option.h"
#include "cli/tool.h"

using namespace find_case;

namespace {

Eigen::Vector3d axis_of(const std::string& name)
{
    const double sign = name[0] == '-' ? -1 : 1;
    return sign * Eigen::Vector3d::Unit(name.back() - 'x');
}

/// The base as it is seen, mm.
mesh::CloudMesh read_base(const std::string& path, const std::string& up, double scale)
{
    mesh::CloudMesh base = mesh::read_cloud_mesh(path, {}).part;
    const Eigen::Matrix3d turn = core::rotation_between(axis_of(up), Vector3d::UnitZ());
    base.points.xyz = (scale * turn * base.points.xyz).eval();
    base.points.fields.clear();
    if (base.is_mesh()) return base;
    std::vector<Index> finite;
    for (Index i = 0; i < base.points.size(); ++i)
        if (base.points.xyz.col(i).allFinite()) finite.push_back(i);
    base.points = cloud::select_points(base.points, finite);
    return base;
}

/// Points lifted by the anomalies.
Eigen::Matrix3Xd lifted(Eigen::Matrix3Xd points, const std::vector<Placed>& placed)
{
    for (auto point : points.colwise()) point.z() += truth_at(placed, point.head<2>()).second;
    return points;
}

/// The scan of a mesh's map, lifted by the anomalies.
Eigen::Matrix3Xd scan_of(const find::HeightMap& map, const std::vector<Placed>& placed, double sigma, Random& random)
{
    find::HeightMap worn = map;
    worn.z = map.z.clone();
    for (int y = 0; y < map.z.rows; ++y)
        for (int x = 0; x < map.z.cols; ++x) worn.z(y, x) += float(truth_at(placed, map.point_at(x, y)).second);
    worn.z = scanned(worn, sigma, random);
    return points_of(worn);
}

void set_truth(cloud::Cloud& worn, const std::vector<Placed>& placed)
{
    Eigen::VectorXd truth(worn.size()), height(worn.size());
    for (Index i = 0; i < worn.size(); ++i) std::tie(truth[i], height[i]) = truth_at(placed, worn.xyz.col(i).head<2>());
    cloud::set_field(worn, "truth", truth);
    cloud::set_field(worn, "truth_height", height);
}

} // namespace

int main(int argc, char** argv)
{
    return cli::tool_main(argc, argv, "A scan with anomalies whose truth is known.", [](cli::Tool& t) {
        const std::string& path = t.main_input("BASE", "a mesh or a cloud");
        const std::string& up = t.choice("--up", "z", {"x", "y", "z", "-x", "-y", "-z"}, "seen from there");
        const double& scale = t.number("--scale", 1, "MM", "unit of BASE");
        const double& cell = t.number("--cell", 1, "MM", "spacing of the scan", core::Range::positive());
        const double& sigma = t.number("--sigma", 0, "MM", "of the scan's noise; for a cloud, of its own");
        const int& number = t.count("--number", 1, "of the case: the draws' seed", 0, 1000000);
        const int& count = t.count("--anomalies", 0, "how many", 0, 20);
        const bool& at_edge = t.flag("--edge", "they stand at edges");
        const bool& faint = t.flag("--faint", "they stand out as little as what a part has of its own");
        const double& warp = t.number("--bend", 0, "MM", "of slow form");
        const std::string& design = t.optional_output("--design", "the base as it lies", {"stl"});
        t.parse();
        const mesh::CloudMesh base = read_base(path, up, scale);
        find::HeightMap map = base.is_mesh() ? sampled(base, cell) : find::height_map(base, find::View::Identity());
        if (!base.is_mesh()) find::clean(map, true);
        Random random(std::uint64_t(number) * 7919 + std::uint64_t(std::abs(std::lround(1e3 * map.origin.sum()))));
        const std::vector<Placed> placed =
            place_anomalies(ground_of(map, sigma), number, count, {at_edge, faint}, random);

        cloud::Cloud worn;
        worn.xyz = base.is_mesh() ? scan_of(map, placed, sigma, random) : lifted(base.points.xyz, placed);
        set_truth(worn, placed);
        const Eigen::AlignedBox3d box = geometry::bounding_box(worn.xyz);
        if (warp > 0)
            for (auto point : worn.xyz.colwise()) point.z() += bend(point.head<2>(), box, warp, number);
        mesh::write_cloud_mesh(t.output(), {worn, {}}, mesh::PartFormat::pcd, {});
        if (!design.empty()) mesh::write_cloud_mesh(t.output_file(design), base, mesh::PartFormat::stl, {});
        t.note(std::to_string(placed.size()) + " anomalies");
        return cli::Verdict::yes;
    });
}
