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

namespace fettle {

namespace {

/// @param heights  of the surface through the points at known.inside
template <typename Heights>
SubsetError band_of(const KnownSurface& known, const Heights& heights)
{
    return [known, heights](const std::vector<Eigen::Index>& subset) {
        Eigen::Matrix3Xd points(3, static_cast<Eigen::Index>(subset.size()) + known.always.cols());
        points << known.candidates(Eigen::all, subset), known.always;
        try {
            const Eigen::VectorXd errors = heights(points) - known.truth;
            if (!errors.hasNaN()) return error_band(errors);
        } catch (const InputError&) {
            // too few points, or on a line: no surface either
        }
        return std::numeric_limits<double>::infinity();
    };
}

// Places over the longer side of B: the band of a fit through 16 touches is known within 1 % from so many.
constexpr int kPlacesAcross = 20;

} // namespace

KnownSurface touch_known_surface(const Scan& surface, const Job& job, double spacing)
{
    KnownSurface known;
    known.angle = job.theta;
    known.always.resize(3, 0);
    known.inside = anomaly_grid(job, kPlacesAcross);
    known.truth.resize(known.inside.cols());
    for (Eigen::Index i = 0; i < known.truth.size(); ++i) {
        const std::optional<double> z = surface.height(known.inside.col(i));
        if (!z)
            throw InputError("no surface inside the anomaly at " + place(known.inside.col(i), job.units) +
                             ", where a search for the best touches must know it");
        known.truth[i] = *z;
    }
    const Eigen::Matrix2Xd places = candidate_touches(job, spacing);
    std::vector<Eigen::Vector3d> found;
    for (const Eigen::Vector2d& xy : places.colwise())
        if (const std::optional<double> z = surface.height(xy)) found.emplace_back(xy.x(), xy.y(), *z);
    known.candidates.resize(3, static_cast<Eigen::Index>(found.size()));
    for (std::size_t i = 0; i < found.size(); ++i) known.candidates.col(static_cast<Eigen::Index>(i)) = found[i];
    return known;
}

SubsetError griddata_band(const KnownSurface& known, double spacing)
{
    return band_of(known, [inside = known.inside, angle = known.angle, spacing](const Eigen::Matrix3Xd& points) {
        return griddata_heights(points, spacing, angle, inside);
    });
}

SubsetError tensor_bspline_band(const KnownSurface& known)
{
    return band_of(known, [inside = known.inside, angle = known.angle](const Eigen::Matrix3Xd& points) {
        const TensorBspline surface =
            TensorBsplineSystem(points.topRows<2>(), angle).surface(points.row(2).transpose());
        Eigen::VectorXd z(inside.cols());
        for (Eigen::Index i = 0; i < z.size(); ++i) z[i] = height(surface, inside.col(i));
        return z;
    });
}

} // namespace fettle
