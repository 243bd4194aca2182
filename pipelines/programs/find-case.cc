// A scan with anomalies whose truth is known, to judge fettle-find by:    find-case BASE --number K --anomalies N -o
// worn.pcd
//
// BASE, a mesh or a cloud, is seen from --up; a mesh is sampled at the cells of a grid as a scanner would, a cloud
// keeps its own points and noise. Up to N anomalies of the seven kinds of fettle-part stand on its smooth places, away
// from edges or (--edge) over them; their kinds, sizes and places follow from --number alone. Then come the scanner's
// faults: white noise and half as much that is correlated over three cells, flying points, dropouts, faces steeper than
// 78° that are hardly seen. Out: PCD with the fields `truth` (0, or the number of the anomaly that a point is on) and
// `truth_height` (of that anomaly, mm).
#include "cli/option.h"
#include "cli/tool.h"
#include "core/constants.h"
#include "core/error.h"
#include "find/view.h"
#include "geometry/bounding_box.h"
#include "geometry/uniform_draws.h"
#include "mesh/mesh_index.h"
#include "part/profile.h"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

using namespace fettle;
using Eigen::Index, Eigen::Vector2d, Eigen::Vector3d;
using find::Image, find::Mask;
using std::numbers::pi;

namespace {

using Random = std::mt19937_64;

double draw_between(Random& random, double low, double high)
{
    return low + (high - low) * geometry::draw_uniform(random);
}

double draw_log(Random& random, double low, double high)
{
    return std::exp(draw_between(random, std::log(low), std::log(high)));
}

// --- anomalies
// ----------------------------------------------------------------------------------------------------------
enum class Kind { bead, burr, dot, ring, stub, blob, hill };
constexpr int kKinds = 7;

// Heights that are truth: less is the foot of a hill, which no scan shows. mm
constexpr double kMinTruthHeight = 0.05;

struct Placed {
    part::Anomaly anomaly;
    Vector2d centre; // mm
    double reach;    // of its foot from there, mm
};

Eigen::Matrix2Xd turned(const Eigen::Matrix2Xd& points, const Vector2d& centre, double angle)
{
    return (Eigen::Rotation2Dd(angle) * points).colwise() + centre;
}

/// A path along x with `corners` corners, `length` long, each off it by a normal deviate.
Eigen::Matrix2Xd wavy_path(Random& random, int corners, double length, double deviation)
{
    Eigen::Matrix2Xd path(2, corners);
    for (int k = 0; k < corners; ++k)
        path.col(k) << length * (double(k) / (corners - 1) - 0.5), geometry::draw_normal(random, deviation);
    return path;
}

Eigen::Matrix2Xd irregular_outline(Random& random, double radius)
{
    constexpr int kCorners = 9;
    Eigen::Matrix2Xd outline(2, kCorners);
    for (int k = 0; k < kCorners; ++k) {
        const double turn = 2 * pi * k / kCorners + draw_between(random, -0.2, 0.2);
        outline.col(k) = radius * draw_between(random, 0.65, 1.35) * Vector2d(std::cos(turn), std::sin(turn));
    }
    return outline;
}

Eigen::Matrix2Xd ellipse(double a, double b)
{
    constexpr int kCorners = 64;
    Eigen::Matrix2Xd outline(2, kCorners);
    for (int k = 0; k < kCorners; ++k) {
        const double turn = 2 * pi * k / kCorners;
        outline.col(k) << a * std::cos(turn), b * std::sin(turn);
    }
    return outline;
}

/// Draft of walls, rad: so steep that a crest or a top of some width remains.
double draft(Random& random, double low, double high, double width, double height)
{
    return std::min(core::kRadPerDegree * draw_between(random, low, high), std::atan(0.4 * width / height));
}

/// An anomaly of a kind about a place. @param width  across it, mm
Placed make_anomaly(Kind kind, const Vector2d& centre, double width, double height, Random& random)
{
    const double angle = draw_between(random, 0, 2 * pi);
    const part::Roughness rough{draw_between(random, 0.05, 0.35), width * draw_between(random, 0.3, 0.8), random()};
    const double half = width / 2;
    switch (kind) {
    case Kind::bead: {
        const double length = width * draw_between(random, 1.5, 4);
        const auto path = turned(wavy_path(random, 5, length, 0.12 * width), centre, angle);
        return {part::roughened(part::ridge_along(path, {width, height, true, 0}), rough), centre, length / 2 + half};
    }
    case Kind::burr: {
        const double length = width * draw_between(random, 2, 5);
        const auto path = turned(wavy_path(random, 4, length, 0.15 * width), centre, angle);
        const part::RidgeSection section{width, height, false, draft(random, 3, 45, width, height)};
        return {part::roughened(part::ridge_along(path, section), rough), centre, length / 2 + half};
    }
    case Kind::dot:
        return {part::dot(centre, half, std::min(height, 0.45 * width)), centre, half};
    case Kind::ring: {
        const double radius = width * draw_between(random, 1.1, 1.8);
        return {part::ring(centre, radius, {width, height, true, 0}), centre, radius + half};
    }
    case Kind::stub: {
        const part::SlopedTop top{height, height * draw_between(random, 1, 1.4), angle};
        const auto outline = turned(ellipse(1.3 * half, half), centre, angle);
        return {part::stub(outline, top, draft(random, 2, 60, width, top.high)), centre, 1.3 * half};
    }
    case Kind::blob: {
        const auto outline = turned(irregular_outline(random, half), centre, angle);
        return {part::roughened(part::blob(outline, height, width * draw_between(random, 0.1, 0.35)), rough), centre,
                1.35 * half};
    }
    case Kind::hill:
        break;
    }
    return {part::hill(centre, {0.8 * width, 0.55 * width}, angle, height), centre, 0.8 * width};
}

// --- where they stand
// ---------------------------------------------------------------------------------------------------
constexpr int kMaxTries = 400;
constexpr double kMaxSmoothSlope = 1; // of places where anomalies stand
// Sizes, in cells and mm.
constexpr double kMinWidthCells = 6, kMinWidth = 3, kMaxWidth = 40;
constexpr double kMaxExtentCells = 25, kMinMaxExtent = 60;
constexpr double kMinHeightSigmas = 8, kMinHeight = 0.3, kMaxHeight = 6;

struct Ground {
    find::HeightMap map;
    double sigma; // of the scan to be, mm
    Image room;   // distance of each cell to the nearest that is steep or not seen, mm
};

Ground ground_of(const find::HeightMap& map, double sigma)
{
    const Image z = find::filled(find::smoothed(map.z, map.seen, 1.5));
    Mask good = find::closed(map.seen, 1);
    for (int y = 0; y < z.rows; ++y)
        for (int x = 0; x < z.cols; ++x) {
            const float dx = z(y, std::min(x + 1, z.cols - 1)) - z(y, std::max(x - 1, 0));
            const float dy = z(std::min(y + 1, z.rows - 1), x) - z(std::max(y - 1, 0), x);
            if (std::hypot(dx, dy) / (2 * map.cell) >= kMaxSmoothSlope) good(y, x) = 0;
        }
    good = find::dilated(find::eroded(good, 2), 2);
    return {map, sigma, find::depth_of(good) * map.cell};
}

/// Cells where an anomaly of a reach may have its centre.
std::vector<cv::Point> places_for(const Ground& ground, Kind kind, double reach, bool at_edge,
                                  const std::vector<Placed>& others)
{
    const double cell = ground.map.cell;
    const bool is_round = kind == Kind::dot || kind == Kind::hill || kind == Kind::blob;
    const double low = !at_edge ? reach + 3 * cell : (is_round ? 0.9 : 0.55) * reach;
    const double high = !at_edge ? core::kInfinity : (is_round ? 1.25 : 1) * reach;
    std::vector<cv::Point> places;
    for (int y = 0; y < ground.room.rows; ++y)
        for (int x = 0; x < ground.room.cols; ++x) {
            if (!(ground.room(y, x) > low && ground.room(y, x) < high)) continue;
            const Vector2d p = ground.map.point_at(x, y);
            if (std::ranges::all_of(others, [&](const Placed& other) {
                    const double both = other.reach + reach;
                    return (other.centre - p).norm() > both + std::max(6 * cell, 0.3 * both);
                }))
                places.emplace_back(x, y);
        }
    return places;
}

std::vector<Placed> place_anomalies(const Ground& ground, int number, int count, bool at_edge, Random& random)
{
    const double cell = ground.map.cell;
    double room = 0;
    cv::minMaxLoc(ground.room, nullptr, &room);
    const double min_width = std::max(kMinWidth, kMinWidthCells * cell);
    const double max_width = std::max(1.3 * min_width, std::min(kMaxWidth, room * (cell < 2 ? 0.9 : 1.5)));
    const double min_height = std::max(kMinHeight, kMinHeightSigmas * ground.sigma);
    std::vector<Placed> placed;
    for (int attempt = 0; attempt < count * kMaxTries && int(placed.size()) < count; ++attempt) {
        double width = draw_log(random, min_width, max_width);
        const double max_height = std::max(1.2 * min_height, std::min(kMaxHeight, 0.5 * width));
        const double height = draw_log(random, min_height, max_height);
        const auto kind = Kind((number * 3 + int(placed.size()) * 2 + int(geometry::draw_index(random, 2))) % kKinds);
        if (kind == Kind::ring) width = std::max(0.8 * min_width, 0.45 * width);
        const std::uint64_t form = random();
        Random own(form);
        const double reach = make_anomaly(kind, {0, 0}, width, std::min(height, 0.5 * width), own).reach;
        if (2 * reach > std::max(kMinMaxExtent, kMaxExtentCells * cell)) continue;
        const std::vector<cv::Point> places = places_for(ground, kind, reach, at_edge, placed);
        if (places.size() < 10) continue;
        const cv::Point place = places[geometry::draw_index(random, places.size())];
        own.seed(form);
        placed.push_back(
            make_anomaly(kind, ground.map.point_at(place.x, place.y), width, std::min(height, 0.5 * width), own));
    }
    return placed;
}

// --- the scan
// -----------------------------------------------------------------------------------------------------------
constexpr double kSteepSlope = 4.7; // 78°
constexpr double kSteepDropout = 0.7, kDropout = 0.003, kFlying = 0.0007;
constexpr double kFlyingSigmas = 30;
constexpr double kCorrelationCells = 3, kCorrelatedShare = 0.5;

/// White noise smoothed over some cells, of standard deviation 1.
Image correlated_noise(Random& random, cv::Size size)
{
    Image noise(size);
    for (float& value : noise) value = float(geometry::draw_normal(random, 1));
    cv::GaussianBlur(noise, noise, {}, kCorrelationCells, kCorrelationCells, cv::BORDER_REFLECT);
    return noise * (2 * kCorrelationCells * std::sqrt(pi));
}

/// What a scanner makes of a clean map.
Image scanned(const find::HeightMap& map, double sigma, Random& random)
{
    Image z = map.z + kCorrelatedShare * sigma * correlated_noise(random, map.z.size());
    for (int y = 0; y < z.rows; ++y)
        for (int x = 0; x < z.cols; ++x) {
            z(y, x) += float(geometry::draw_normal(random, sigma));
            const float dx = map.z(y, std::min(x + 1, z.cols - 1)) - map.z(y, std::max(x - 1, 0));
            const float dy = map.z(std::min(y + 1, z.rows - 1), x) - map.z(std::max(y - 1, 0), x);
            const bool is_steep = std::hypot(dx, dy) / (2 * map.cell) > kSteepSlope;
            if (geometry::draw_uniform(random) < (is_steep ? kSteepDropout : kDropout))
                z(y, x) = std::numeric_limits<float>::quiet_NaN();
            if (geometry::draw_uniform(random) < kFlying)
                z(y, x) += float(geometry::draw_normal(random, kFlyingSigmas * sigma));
        }
    const auto blocks = int(geometry::draw_index(random, 3));
    for (int k = 0; k < blocks; ++k) {
        const cv::Point at(int(geometry::draw_index(random, std::size_t(z.cols))),
                           int(geometry::draw_index(random, std::size_t(z.rows))));
        const int r = 1 + int(geometry::draw_index(random, 3));
        z(cv::Rect(at.x - r, at.y - r, 2 * r, 2 * r) & cv::Rect({0, 0}, z.size())).setTo(core::kNaN);
    }
    return z;
}

find::HeightMap sampled(const mesh::CloudMesh& part, double cell)
{
    const Eigen::AlignedBox3d box = geometry::bounding_box(part.points.xyz);
    find::HeightMap map;
    map.cell = cell;
    map.origin = box.min().head<2>().array() + cell / 2;
    map.z = Image(int(box.sizes().y() / cell), int(box.sizes().x() / cell));
    const mesh::Mesh mesh{part.points.xyz, part.triangles};
    const mesh::MeshIndex index(mesh);
    for (int y = 0; y < map.z.rows; ++y)
        for (int x = 0; x < map.z.cols; ++x) {
            const Vector2d p = map.point_at(x, y);
            const auto hit = index.highest(p.x(), p.y());
            map.z(y, x) = hit ? float(hit->point.z()) : std::numeric_limits<float>::quiet_NaN();
        }
    map.seen = find::finite(map.z);
    return map;
}

/// Points of a map's cells.
Eigen::Matrix3Xd points_of(const find::HeightMap& map)
{
    std::vector<Vector3d> points;
    for (int y = 0; y < map.z.rows; ++y)
        for (int x = 0; x < map.z.cols; ++x)
            if (std::isfinite(map.z(y, x))) {
                const Vector2d p = map.point_at(x, y);
                points.emplace_back(p.x(), p.y(), map.z(y, x));
            }
    return points.empty() ? Eigen::Matrix3Xd()
                          : Eigen::Map<Eigen::Matrix3Xd>(points[0].data(), 3, Index(points.size()));
}

/// Slow form: two waves of one half to one length over the part, of amplitude `size` together, mm.
double bend(const Vector2d& p, const Eigen::AlignedBox3d& box, double size, int number)
{
    const Vector2d share = (p - box.center().head<2>()) / box.sizes().head<2>().maxCoeff();
    Random random(0x9e3779b97f4a7c15U + std::uint64_t(number));
    double sum = 0;
    for (int k = 0; k < 2; ++k) {
        const double turn = draw_between(random, 0, 2 * pi), waves = draw_between(random, 0.5, 1),
                     phase = draw_between(random, 0, 2 * pi);
        sum += std::sin(2 * pi * waves * share.dot(Vector2d(std::cos(turn), std::sin(turn))) + phase) / 2;
    }
    return size * sum;
}

Eigen::Vector3d axis_of(const std::string& name)
{
    const double sign = name[0] == '-' ? -1 : 1;
    return sign * Eigen::Vector3d::Unit(name.back() - 'x');
}

/// The base as it is seen, mm.
mesh::CloudMesh read_base(const std::string& path, const std::string& up, double scale)
{
    mesh::CloudMesh base = mesh::read_cloud_mesh(path, {}).part;
    const Eigen::Quaterniond turn = Eigen::Quaterniond::FromTwoVectors(axis_of(up), Vector3d::UnitZ());
    base.points.xyz = (scale * turn.toRotationMatrix() * base.points.xyz).eval();
    base.points.fields.clear();
    if (base.is_mesh()) return base;
    std::vector<Index> finite;
    for (Index i = 0; i < base.points.size(); ++i)
        if (base.points.xyz.col(i).allFinite()) finite.push_back(i);
    base.points = cloud::select_points(base.points, finite);
    return base;
}

/// Number and height of the anomaly at a place; 0 where none is.
std::pair<int, double> truth_at(const std::vector<Placed>& placed, const Vector2d& p)
{
    std::pair<int, double> best{0, 0};
    double highest = kMinTruthHeight;
    for (std::size_t k = 0; k < placed.size(); ++k)
        if (const double h = placed[k].anomaly.height(p); h > highest) {
            highest = h;
            best = {int(k) + 1, h};
        }
    return best;
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
        const double& warp = t.number("--bend", 0, "MM", "of slow form");
        const std::string& design = t.optional_output("--design", "the base as it lies, STL");
        t.parse();
        const mesh::CloudMesh base = read_base(path, up, scale);
        find::HeightMap map = base.is_mesh() ? sampled(base, cell) : find::height_map(base, find::View::Identity());
        if (!base.is_mesh()) find::clean(map);
        Random random(std::uint64_t(number) * 7919 + std::uint64_t(std::abs(std::lround(1e3 * map.origin.sum()))));
        const std::vector<Placed> placed = place_anomalies(ground_of(map, sigma), number, count, at_edge, random);

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
