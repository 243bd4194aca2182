#include "machining/patch_error.h"

#include "compare/signed_distance.h"
#include "core/constants.h"
#include "geometry/bounding_box.h"
#include "machining/tilt.h"
#include "machining/walls.h"
#include "mesh/mesh_index.h"

#include <Eigen/Geometry>
#include <tbb/parallel_for.h>

#include <cmath>
#include <utility>

namespace fettle::machining {
namespace {

/// The machined vertices, projected along Z onto the design.
Eigen::Matrix3Xd project(const Eigen::Matrix3Xd& vertices, const mesh::Mesh& design)
{
    const mesh::MeshIndex index(design);
    Eigen::Matrix3Xd projected = vertices;
    tbb::parallel_for(Eigen::Index{0}, vertices.cols(), [&](Eigen::Index v) {
        const auto hit = index.highest(vertices(0, v), vertices(1, v));
        projected(2, v) = hit ? hit->point.z() : core::kNaN;
    });
    return projected;
}

/// Square root of the mean area of the triangles in plan view, mm.
double mean_triangle_size(const mesh::Mesh& mesh)
{
    const Eigen::Vector3d size = geometry::finite_bounding_box(mesh.vertices).sizes();
    return std::sqrt(size.x() * size.y() / std::max<Eigen::Index>(mesh.triangles.cols(), 1));
}

void set_patch(PatchErrors& errors, Eigen::Index t, const mesh::Mesh& machined, const Walls& walls)
{
    const mesh::Triangle above = mesh::triangle_of(machined, t);      // A″ B″ C″
    const mesh::Triangle below = mesh::triangle_of(errors.design, t); // A B C
    errors.centre.col(t) = above.rowwise().mean();
    PatchState& state = errors.state[t];
    const Eigen::Vector3d machined_normal = (above.col(1) - above.col(0)).cross(above.col(2) - above.col(0));
    errors.machined_area[t] = machined_normal.norm() / 2;
    if (!(machined_normal.z() > 0))
        state = PatchState::turned_away;
    else if (!below.allFinite())
        state = PatchState::not_hit;
    else if (walls.intersects(below.topRows<2>()))
        state = PatchState::vertical;
    errors.beyond_border[t] = !below.allFinite() && !walls.intersects(above.topRows<2>());
    if (state != PatchState::defined) return;
    const Eigen::Vector3d N =
        (below.col(1) - below.col(0)).cross(below.col(2) - below.col(0)); // upwards, like the machined triangle's
    const double norm = N.norm();
    errors.d[t] = (above.row(2) - below.row(2)).mean();
    errors.mu[t] = N.z() / norm * errors.d[t];
    errors.normal.col(t) = N / norm;
    errors.area[t] = norm / 2;
}

} // namespace

PatchErrors patch_errors(const mesh::Mesh& machined, const mesh::Mesh& design)
{
    const Walls walls(design, mean_triangle_size(machined));
    const Eigen::Index count = machined.triangles.cols();
    PatchErrors errors;
    errors.design.vertices = project(machined.vertices, design);
    errors.design.triangles = machined.triangles;
    errors.z_error = (machined.vertices.row(2) - errors.design.vertices.row(2)).transpose();
    errors.centre.resize(3, count);
    errors.normal = Eigen::Matrix3Xd::Constant(3, count, core::kNaN);
    errors.d = errors.mu = errors.area = errors.machined_area = Eigen::VectorXd::Constant(count, core::kNaN);
    errors.state.resize(count, PatchState::defined);
    errors.beyond_border.resize(count, false);
    tbb::parallel_for(Eigen::Index{0}, count, [&](Eigen::Index t) { set_patch(errors, t, machined, walls); });
    return errors;
}

Eigen::VectorXd closest_errors(const PatchErrors& errors, const mesh::Mesh& design, bool design_is_closed)
{
    Eigen::VectorXd closest = compare::signed_distance(errors.centre, design).error;
    for (Eigen::Index t = 0; t < closest.size(); ++t)
        if (!design_is_closed && errors.beyond_border[t]) closest[t] = core::kNaN;
    return closest;
}

PatchErrors rotated(PatchErrors errors, const Eigen::Matrix3d& rotation)
{
    if (rotation.isIdentity(0)) return errors;
    errors.design = rotated(std::move(errors.design), rotation);
    errors.centre = (rotation * errors.centre).eval();
    errors.normal = (rotation * errors.normal).eval();
    errors.up = (rotation * errors.up).eval();
    return errors;
}

std::string to_string(ErrorClass error_class)
{
    static constexpr std::array kNames = {"serious_over_cut", "slight_over_cut", "neutral", "slight_under_cut",
                                          "serious_under_cut"};
    return kNames[static_cast<int>(error_class) + 2];
}

std::string to_string(PatchState state)
{
    static constexpr std::array kNames = {"defined", "not_hit", "vertical", "turned_away"};
    return kNames[static_cast<int>(state)];
}

ErrorClass classify(double error, const PatchTolerances& tolerances)
{
    if (error < -tolerances.inner) return ErrorClass::serious_over_cut;
    if (error < -tolerances.inner * tolerances.neutral) return ErrorClass::slight_over_cut;
    if (error <= tolerances.outer * tolerances.neutral) return ErrorClass::neutral;
    return error <= tolerances.outer ? ErrorClass::slight_under_cut : ErrorClass::serious_under_cut;
}

std::array<std::uint8_t, 3> colour(ErrorClass error_class)
{
    static constexpr std::array<std::array<std::uint8_t, 3>, 5> kColours = {
        {{255, 0, 0}, {139, 0, 0}, {225, 225, 225}, {148, 0, 211}, {0, 0, 139}}};
    return kColours[static_cast<int>(error_class) + 2];
}

} // namespace fettle::machining
