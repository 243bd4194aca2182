#include "machining/patch_error.h"

#include "machining/tilt.h"
#include "machining/walls.h"
#include "mesh/mesh_index.h"

#include <Eigen/Geometry>
#include <tbb/parallel_for.h>

#include <cmath>
#include <limits>
#include <utility>

namespace fettle {
namespace {

constexpr double kUndefined = std::numeric_limits<double>::quiet_NaN();

/// The machined vertices moved along Z onto the design.
Eigen::Matrix3Xd resampled(const Eigen::Matrix3Xd& vertices, const Mesh& design)
{
    const MeshIndex index(design);
    Eigen::Matrix3Xd moved = vertices;
    tbb::parallel_for(Eigen::Index{0}, vertices.cols(), [&](Eigen::Index v) {
        const auto hit = index.highest(vertices(0, v), vertices(1, v));
        moved(2, v) = hit ? hit->point.z() : kUndefined;
    });
    return moved;
}

/// Side of a square as large as the triangles are on average.
double mean_size(const Mesh& mesh)
{
    const Eigen::Matrix<double, 3, 2> box = bounding_box(mesh.vertices);
    const Eigen::Vector2d size = (box.col(1) - box.col(0)).head<2>();
    return std::sqrt(size.x() * size.y() / static_cast<double>(std::max<Eigen::Index>(mesh.triangles.cols(), 1)));
}

void set_patch(PatchErrors& errors, Eigen::Index t, const Mesh& machined, const Walls& walls)
{
    const Eigen::Vector3i corners = machined.triangles.col(t);
    Eigen::Matrix3d above, below; // columns: A″ B″ C″ machined, A B C on the design
    for (int k = 0; k < 3; ++k) {
        above.col(k) = machined.vertices.col(corners[k]);
        below.col(k) = errors.design.vertices.col(corners[k]);
    }
    errors.centre.col(t) = above.rowwise().mean();
    errors.normal.col(t).setConstant(kUndefined);
    errors.d[t] = errors.mu[t] = errors.area[t] = kUndefined;
    PatchState& state = errors.state[static_cast<std::size_t>(t)];
    const double turned = (above.col(1) - above.col(0)).cross(above.col(2) - above.col(0)).z();
    if (!(turned > 0))
        state = PatchState::turned_away;
    else if (!below.allFinite())
        state = PatchState::not_hit;
    else if (walls.meet(below.topRows<2>()))
        state = PatchState::vertical;
    if (state != PatchState::defined) return;
    const Eigen::Vector3d N = (below.col(1) - below.col(0)).cross(below.col(2) - below.col(0)); // up, as the machined
    const double size = N.norm();
    errors.d[t] = (above.row(2) - below.row(2)).mean();
    errors.mu[t] = N.z() / size * errors.d[t];
    errors.normal.col(t) = N / size;
    errors.area[t] = size / 2;
}

} // namespace

PatchErrors patch_errors(const Mesh& machined, const Mesh& design)
{
    const Walls walls(design, mean_size(machined));
    const Eigen::Index count = machined.triangles.cols();
    PatchErrors errors;
    errors.design.vertices = resampled(machined.vertices, design);
    errors.design.triangles = machined.triangles;
    errors.z_error = (machined.vertices.row(2) - errors.design.vertices.row(2)).transpose();
    errors.centre.resize(3, count);
    errors.normal.resize(3, count);
    errors.d.resize(count);
    errors.mu.resize(count);
    errors.area.resize(count);
    errors.state.resize(static_cast<std::size_t>(count), PatchState::defined);
    tbb::parallel_for(Eigen::Index{0}, count, [&](Eigen::Index t) { set_patch(errors, t, machined, walls); });
    return errors;
}

PatchErrors turned(PatchErrors errors, const Eigen::Matrix3d& rotation)
{
    if (rotation.isIdentity(0)) return errors;
    errors.design = turned(std::move(errors.design), rotation);
    errors.centre = (rotation * errors.centre).eval();
    errors.normal = (rotation * errors.normal).eval();
    errors.up = (rotation * errors.up).eval();
    return errors;
}

std::string to_string(ErrorClass error_class)
{
    switch (error_class) {
    case ErrorClass::serious_over_cut:
        return "serious_over_cut";
    case ErrorClass::slight_over_cut:
        return "slight_over_cut";
    case ErrorClass::neutral:
        return "neutral";
    case ErrorClass::slight_under_cut:
        return "slight_under_cut";
    case ErrorClass::serious_under_cut:
        break;
    }
    return "serious_under_cut";
}

std::string to_string(PatchState state)
{
    switch (state) {
    case PatchState::defined:
        return "defined";
    case PatchState::not_hit:
        return "not_hit";
    case PatchState::vertical:
        return "vertical";
    case PatchState::turned_away:
        break;
    }
    return "turned_away";
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
    switch (error_class) {
    case ErrorClass::serious_over_cut:
        return {255, 0, 0};
    case ErrorClass::slight_over_cut:
        return {139, 0, 0};
    case ErrorClass::neutral:
        return {225, 225, 225};
    case ErrorClass::slight_under_cut:
        return {148, 0, 211};
    case ErrorClass::serious_under_cut:
        break;
    }
    return {0, 0, 139};
}

} // namespace fettle
