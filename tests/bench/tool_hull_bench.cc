// A ball-end tool against a boat's hull of 100,000 and of a million triangles, 50,000 poses of a raster: ball of radius
// 6, shank of radius 5 and length 40 from its centre up, spindle of radius 45 and length 90 above. The ball is 0.02 mm
// clear of the hull, but for one pose of 20 that gouges 0.05 mm; the axis leans a fifth of the way to the normal.
//
//   minimum   signed clearance of the tool: the ball's bounds that of the shank, and theirs that of the spindle
//   each      signed clearance of every part by itself
//   embree    does each part overlap a triangle? By rtcPointQuery around spheres along the axis, every triangle exactly
//   fcl       the same by its oriented boxes, on every 19th pose
//
// One core, cpu time; rounds of all in turn, and the middle one of the ratios of each round. The counts of overlapping
// poses must be the same. With arguments, the numbers of triangles. With `brute` before them instead: the verdicts of
// all parts at all poses, deeper than 0.01 mm or not, against every triangle one by one; minutes.

#include "../lib/boat_hull.h"
#include "../lib/brute_force.h"
#include "robot/workpiece.h"

#include <embree3/rtcore.h>
#include <fcl/fcl.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <limits>
#include <memory>
#include <string_view>
#include <vector>

using namespace fettle;

namespace {

using Eigen::Isometry3d, Eigen::Vector3d;

constexpr int kPoses = 50000, kRounds = 5, kFclEvery = 19;
constexpr double kBall = boat::kBall, kShank = 5, kShankLength = 40, kSpindle = 45, kSpindleLength = 90;
const std::array<robot::Solid, 3> kTool = {
    robot::solid::Sphere{{0, 0, 0}, kBall}, robot::solid::Cylinder{{0, 0, 0}, {0, 0, kShankLength}, kShank},
    robot::solid::Cylinder{{0, 0, kShankLength}, {0, 0, kShankLength + kSpindleLength}, kSpindle}};
using Hits = std::array<int, 3>;

double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

struct Run {
    double seconds = 0; ///< for all poses
    Hits hits = {};
};

template <typename Query>
Run timed(const std::vector<Isometry3d>& all, std::size_t every, const Query& measure)
{
    Run run;
    const double before = cpu_seconds();
    for (std::size_t k = 0; k < all.size(); k += every) measure(all[k], run.hits);
    run.seconds = (cpu_seconds() - before) * static_cast<double>(every);
    return run;
}

// --- fettle ----------------------------------------------------------------------------------------------------------

/// @param together  the parts bound each other, and `hits` counts which part has the minimum clearance where one
/// overlaps
Run by_clearance(const robot::Workpiece& workpiece, const std::vector<Isometry3d>& all, bool together)
{
    std::array<std::uint32_t, 3> leaf = {};
    return timed(all, 1, [&](const Isometry3d& T, Hits& hits) {
        double min = 50;
        std::size_t who = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const robot::Workpiece::Nearest found =
                workpiece.nearest(robot::PlacedSolid(kTool[k], T), together ? min : 50, leaf[k]);
            leaf[k] = found.leaf;
            if (!together) hits[k] += found.clearance.distance < 0;
            if (found.clearance.distance < min) {
                min = found.clearance.distance;
                who = k;
            }
        }
        if (together) hits[who] += min < 0;
    });
}

// --- Embree ----------------------------------------------------------------------------------------------------------

/// A part of the tool between two heights of its axis; of the ball both are 0.
struct Question {
    const mesh::Mesh& mesh;
    const Isometry3d& T;
    double from, to, radius;
    bool hit = false;
};

bool point_query(RTCPointQueryFunctionArguments* found)
{
    Question& question = *static_cast<Question*>(found->userPtr);
    if (question.hit) return false;
    const mesh::Triangle t = triangle_of(question.mesh, found->primID);
    const Vector3d centre = question.T.translation();
    if (question.to == question.from) {
        question.hit = mesh::closest_on_triangle(t, centre).squared_distance < question.radius * question.radius;
    } else {
        const mesh::Triangle local = question.T.linear().transpose() * (t.colwise() - centre);
        question.hit = reaches_into_cylinder(local, question.from, question.to, question.radius);
    }
    if (question.hit) found->query->radius = 0;
    return question.hit;
}

class Embree {
  public:
    explicit Embree(const mesh::Mesh& mesh)
        : mesh_(mesh), device_(rtcNewDevice("threads=1")), scene_(rtcNewScene(device_))
    {
        const RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
        const auto vertices = static_cast<std::size_t>(mesh.vertices.cols()),
                   triangles = static_cast<std::size_t>(mesh.triangles.cols());
        auto* points = static_cast<float*>(
            rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, vertices));
        Eigen::Matrix3Xf::Map(points, 3, mesh.vertices.cols()) = mesh.vertices.cast<float>();
        void* corners = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, triangles);
        std::memcpy(corners, mesh.triangles.data(), 12 * triangles);
        rtcSetGeometryPointQueryFunction(geometry, point_query);
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene_, geometry);
        rtcReleaseGeometry(geometry);
        rtcCommitScene(scene_);
    }
    ~Embree()
    {
        rtcReleaseScene(scene_);
        rtcReleaseDevice(device_);
    }
    Embree(const Embree&) = delete;
    Embree& operator=(const Embree&) = delete;

    Run run(const std::vector<Isometry3d>& all) const
    {
        return timed(all, 1, [&](const Isometry3d& T, Hits& hits) {
            hits[0] += overlap(T, 0, 0, kBall);
            hits[1] += overlap(T, 0, kShankLength, kShank);
            hits[2] += overlap(T, kShankLength, kShankLength + kSpindleLength, kSpindle);
        });
    }

  private:
    /// Asks around spheres along the part, each about a piece as long as it is wide.
    bool overlap(const Isometry3d& T, double from, double to, double radius) const
    {
        const int pieces = std::max(1, static_cast<int>(std::ceil((to - from) / (2 * radius))));
        const double piece = (to - from) / pieces;
        bool hit = false;
        for (int k = 0; k < pieces && !hit; ++k) {
            Question question = {mesh_, T, from + k * piece, from + (k + 1) * piece, radius};
            const Vector3d centre = T * Vector3d(0, 0, question.from + piece / 2);
            RTCPointQuery query = {};
            Eigen::Vector3f::Map(&query.x) = centre.cast<float>();
            query.radius = static_cast<float>(std::hypot(radius, piece / 2) * (1 + 1e-5));
            RTCPointQueryContext context;
            rtcInitPointQueryContext(&context);
            rtcPointQuery(scene_, &query, &context, nullptr, &question);
            hit = question.hit;
        }
        return hit;
    }

    const mesh::Mesh& mesh_;
    RTCDevice device_;
    RTCScene scene_;
};

// --- FCL -------------------------------------------------------------------------------------------------------------

class Fcl {
  public:
    explicit Fcl(const mesh::Mesh& mesh) : model_(std::make_shared<fcl::BVHModel<fcl::OBBRSSd>>())
    {
        model_->beginModel();
        for (Eigen::Index i = 0; i < mesh.triangles.cols(); ++i) {
            const mesh::Triangle t = triangle_of(mesh, i);
            model_->addTriangle(t.col(0), t.col(1), t.col(2));
        }
        model_->endModel();
    }

    Run run(const std::vector<Isometry3d>& all) const
    {
        fcl::CollisionObjectd hull(model_);
        std::array<fcl::CollisionObjectd, 3> parts = {
            fcl::CollisionObjectd(std::make_shared<fcl::Sphered>(kBall)),
            fcl::CollisionObjectd(std::make_shared<fcl::Cylinderd>(kShank, kShankLength)),
            fcl::CollisionObjectd(std::make_shared<fcl::Cylinderd>(kSpindle, kSpindleLength))};
        const std::array<double, 3> middle = {0, kShankLength / 2, kShankLength + kSpindleLength / 2};
        return timed(all, kFclEvery, [&](const Isometry3d& T, Hits& hits) {
            for (std::size_t k = 0; k < 3; ++k) {
                parts[k].setTransform(T.linear(), T * Vector3d(0, 0, middle[k]));
                parts[k].computeAABB();
                fcl::CollisionResultd result;
                hits[k] += fcl::collide(&hull, &parts[k], fcl::CollisionRequestd(1, false), result) > 0;
            }
        });
    }

  private:
    std::shared_ptr<fcl::BVHModel<fcl::OBBRSSd>> model_;
};

// --- the table -------------------------------------------------------------------------------------------------------

double middle(std::vector<double> list)
{
    std::nth_element(list.begin(), list.begin() + static_cast<std::ptrdiff_t>(list.size() / 2), list.end());
    return list[list.size() / 2];
}

void compare(int triangles)
{
    const mesh::Mesh mesh = boat::hull(triangles);
    const robot::Workpiece workpiece(mesh);
    const Embree embree(mesh);
    const Fcl fcl(mesh);
    const std::vector<Isometry3d> all = boat::poses(kPoses);
    const std::array<const char*, 4> names = {"minimum", "each", "embree", "fcl"};
    std::array<std::vector<double>, 4> seconds, ratios;
    std::array<Run, 4> runs;
    for (int round = 0; round < kRounds; ++round) {
        runs = {by_clearance(workpiece, all, true), by_clearance(workpiece, all, false), embree.run(all), fcl.run(all)};
        for (std::size_t k = 0; k < 4; ++k) {
            seconds[k].push_back(runs[k].seconds);
            ratios[k].push_back(runs[2].seconds / runs[k].seconds);
        }
    }
    std::printf("%ld triangles           poses/s  x Embree  hits: ball shank spindle\n", mesh.triangles.cols());
    for (std::size_t k = 0; k < 4; ++k)
        std::printf("%-20s %15.0f %9.2f %11d %5d %7d\n", names[k], kPoses / middle(seconds[k]), middle(ratios[k]),
                    runs[k].hits[0], runs[k].hits[1], runs[k].hits[2]);
}

void compare_with_brute_force(int triangles)
{
    constexpr double kTolerance = 0.01, kUndecided = 1e-5;
    const mesh::Mesh mesh = boat::hull(triangles);
    const robot::Workpiece workpiece(mesh);
    const std::vector<Isometry3d> all = boat::poses(kPoses);
    Hits deeper = {}, wrong = {}, undecided = {};
    for (std::size_t k = 0; k < 3; ++k)
        for (const Isometry3d& T : all) {
            const double clearance = workpiece.nearest(robot::PlacedSolid(kTool[k], T), 50).clearance.distance;
            const bool deep = any_deeper(mesh, kTool[k], T, kTolerance);
            deeper[k] += deep;
            wrong[k] += deep != (clearance < -kTolerance);
            undecided[k] += std::abs(clearance + kTolerance) < kUndecided;
        }
    std::printf("%ld triangles, %d poses: ball, shank, spindle deeper than %g mm %d %d %d; verdicts wrong %d %d %d; "
                "within %g mm of the tolerance %d %d %d\n",
                mesh.triangles.cols(), kPoses, kTolerance, deeper[0], deeper[1], deeper[2], wrong[0], wrong[1],
                wrong[2], kUndecided, undecided[0], undecided[1], undecided[2]);
}

} // namespace

int main(int argc, char** argv)
{
    const bool brute = argc > 1 && std::string_view(argv[1]) == "brute";
    std::vector<int> sizes = {100000, 1000000};
    if (argc > 1 + brute) sizes.clear();
    for (int i = 1 + brute; i < argc; ++i) sizes.push_back(std::atoi(argv[i]));
    for (const int triangles : sizes) brute ? compare_with_brute_force(triangles) : compare(triangles);
}
