#include "margin/known_band.h"

#include "core/error.h"
#include "job/boundary.h"
#include "margin/anomaly_grid.h"
#include "margin/error_band.h"
#include "surface/griddata.h"
#include "surface/tensor_bspline.h"

#include <limits>
#include <optional>
#include <vector>

namespace fettle::margin {

namespace {

/// @param heights  function that returns the heights at known.inside of the surface through given points
template <typename Heights>
sampling::SubsetError subset_band(const KnownSurface& known, const Heights& heights)
{
    return [known, heights](const std::vector<Eigen::Index>& subset) {
        Eigen::Matrix3Xd points(3, subset.size() + known.fixed_touches.cols());
        points << known.candidates(Eigen::all, subset), known.fixed_touches;
        try {
            const Eigen::VectorXd errors = heights(points) - known.true_heights;
            if (!errors.hasNaN()) return error_band(errors);
        } catch (const core::InputError&) {
            // Too few points, or points on a line, determine no surface.
        }
        return std::numeric_limits<double>::infinity();
    };
}

// Grid points along the longer side of B, which yield the band of a fit through 16 touches within 1 %.
constexpr int kAnomalyPoints = 20;

} // namespace

KnownSurface touch_known_surface(const sampling::Scan& surface, const job::Job& job, double spacing)
{
    KnownSurface known;
    known.angle = job.theta;
    known.fixed_touches.resize(3, 0);
    known.anomaly_places = anomaly_grid(job, kAnomalyPoints);
    known.true_heights.resize(known.anomaly_places.cols());
    for (Eigen::Index i = 0; i < known.true_heights.size(); ++i) {
        const std::optional<double> z = surface.height(known.anomaly_places.col(i));
        if (!z)
            throw core::InputError("no surface inside the anomaly at " +
                                   job::point_text(known.anomaly_places.col(i), job.units) +
                                   ", where a search for the best touches must know it");
        known.true_heights[i] = *z;
    }
    const Eigen::Matrix2Xd places = sampling::candidate_touches(job, spacing);
    std::vector<Eigen::Vector3d> found;
    for (const Eigen::Vector2d& xy : places.colwise())
        if (const std::optional<double> z = surface.height(xy)) found.emplace_back(xy.x(), xy.y(), *z);
    known.candidates.resize(3, found.size());
    for (std::size_t i = 0; i < found.size(); ++i) known.candidates.col(i) = found[i];
    return known;
}

sampling::SubsetError griddata_band(const KnownSurface& known, double spacing)
{
    return subset_band(known,
                       [inside = known.anomaly_places, angle = known.angle, spacing](const Eigen::Matrix3Xd& points) {
                           return surface::griddata_heights(points, spacing, angle, inside);
                       });
}

sampling::SubsetError tensor_bspline_band(const KnownSurface& known)
{
    return subset_band(known, [inside = known.anomaly_places, angle = known.angle](const Eigen::Matrix3Xd& points) {
        const surface::TensorBspline surface =
            surface::TensorBsplineSystem(points.topRows<2>(), angle).surface(points.row(2).transpose());
        Eigen::VectorXd z(inside.cols());
        for (Eigen::Index i = 0; i < z.size(); ++i) z[i] = surface::height(surface, inside.col(i));
        return z;
    });
}

} // namespace fettle::margin
