#pragma once

#include "cli/tool.h"
#include "core/constants.h"
#include "geometry/bounding_box.h"
#include "job/boundary.h"
#include "margin/anomaly_grid.h"
#include "margin/error_band.h"
#include "surface/delaunay.h"
#include "surface/griddata.h"
#include "tables.h"

#include <algorithm>
#include <cmath>
#include <vector>

/// What the paper leaves open about its simulations with griddata, so that each guess can be tested.
namespace fettle::study {

struct Variant {
    sampling::TouchNoise noise = kNoise;
    bool linear = false;        ///< Matlab's default, planes over the triangles, instead of its option 'cubic'
    double spacing = -1;        ///< of the uniform sampling, in; 0: interpolated once; -1: half the mean distance
    bool corners = false;       ///< the corners of the sampling boundary are touched, too
    bool over_sampling = false; ///< the error inside the sampling boundary, not inside the anomaly
    bool largest = false;       ///< the largest |error|, not the band
    bool anywhere = false;      ///< Table 4-3: touches anywhere on their side, not one in each of equal parts
    bool one_cubic = false;     ///< Table 4-3: one cubic by least squares through all touches of a curve, not a spline
};

/// The options of a variant; read it after parse().
class VariantOptions {
  public:
    explicit VariantOptions(cli::Tool& t)
        : noise_(t.choice("--noise", "uniform", {"uniform", "normal", "sigma", "none"},
                          "Of the touches: ±0.005 in, 99 % within, as the standard deviation, none")),
          linear_(t.flag("--linear", "Griddata 'linear', not 'cubic'")),
          spacing_(t.number("--spacing", -1, "LENGTH", "Of the uniform sampling, in; 0: none; -1: by the points")),
          corners_(t.flag("--corners", "Touch the corners of the sampling boundary, too")),
          over_sampling_(t.flag("--over-sampling", "Errors inside the sampling boundary")),
          largest_(t.flag("--largest", "The largest |error|")),
          anywhere_(t.flag("--anywhere", "Table 4-3: touches anywhere on their side")),
          one_cubic_(t.flag("--one-cubic", "Table 4-3: one cubic by least squares a curve"))
    {
    }
    Variant variant() const
    {
        // 99 % of a normal distribution lie within this many standard deviations.
        constexpr double kSigmas99 = 2.5758293035489;
        using Kind = sampling::TouchNoise::Kind;
        Variant result{kNoise, linear_, spacing_, corners_, over_sampling_, largest_, anywhere_, one_cubic_};
        if (noise_ == "none") result.noise.amplitude = 0;
        if (noise_ == "normal" || noise_ == "sigma") result.noise.kind = Kind::normal;
        if (noise_ == "sigma") result.noise.amplitude *= kSigmas99;
        return result;
    }

  private:
    const std::string& noise_;
    const bool& linear_;
    const double& spacing_;
    const bool& corners_;
    const bool& over_sampling_;
    const bool& largest_;
    const bool& anywhere_;
    const bool& one_cubic_;
};

/// Half the mean distance of points spread evenly over their hull: fit_griddata()'s default.
inline double half_mean_distance(const Eigen::Matrix2Xd& points)
{
    return std::sqrt(job::area(job::convex_hull(points)) / static_cast<double>(points.cols())) / 2;
}

/// Heights of planes over the Delaunay triangles of the points; NaN outside.
inline Eigen::VectorXd linear_heights(const Eigen::Matrix3Xd& points, const Eigen::Matrix2Xd& xy)
{
    constexpr double kOnEdge = 1e-9; // barycentric rounding
    const surface::Triangulation all = surface::delaunay(points.topRows<2>());
    Eigen::VectorXd z = Eigen::VectorXd::Constant(xy.cols(), core::kNaN);
    for (Eigen::Index t = 0; t < all.triangles.cols(); ++t) {
        const Eigen::Vector3i corners = all.triangles.col(t);
        Eigen::Matrix3d basis;
        basis << points(0, corners[0]), points(0, corners[1]), points(0, corners[2]), points(1, corners[0]),
            points(1, corners[1]), points(1, corners[2]), 1, 1, 1;
        const Eigen::Matrix3d inverse = basis.inverse();
        const Eigen::RowVector3d heights = points.row(2)(corners);
        for (Eigen::Index i = 0; i < xy.cols(); ++i) {
            const Eigen::Vector3d share = inverse * xy.col(i).homogeneous();
            if (share.minCoeff() >= -kOnEdge) z[i] = heights * share;
        }
    }
    return z;
}

/// Corners of the hull and the points of a square grid inside it.
inline Eigen::Matrix2Xd uniform_places(const Eigen::Matrix2Xd& points, double spacing)
{
    const job::Polygon hull = job::convex_hull(points);
    const Eigen::AlignedBox2d box = geometry::bounding_box(points);
    std::vector<Eigen::Vector2d> places;
    for (const Eigen::Vector2d& corner : hull.colwise()) places.push_back(corner);
    for (double x = box.min().x(); x <= box.max().x(); x += spacing)
        for (double y = box.min().y(); y <= box.max().y(); y += spacing)
            if (job::contains(hull, {x, y}) && job::distance_to_edge(hull, {x, y}) > spacing / 10)
                places.emplace_back(x, y);
    return job::columns_to_matrix(places);
}

/// The modified griddata of the variant. @return mm; NaN outside the hull
inline Eigen::VectorXd variant_heights(const Variant& variant, const Eigen::Matrix3Xd& points,
                                       const Eigen::Matrix2Xd& xy)
{
    const double spacing = variant.spacing < 0 ? half_mean_distance(points.topRows<2>()) : variant.spacing * kInch;
    if (!variant.linear) return surface::griddata_heights(points, spacing, 0, xy);
    if (spacing == 0) return linear_heights(points, xy);
    const Eigen::Matrix2Xd places = uniform_places(points.topRows<2>(), spacing);
    Eigen::Matrix3Xd nodes(3, places.cols());
    nodes << places, linear_heights(points, places).transpose();
    return linear_heights(nodes(Eigen::all,
                                [&] {
                                    std::vector<Eigen::Index> defined;
                                    for (Eigen::Index i = 0; i < nodes.cols(); ++i)
                                        if (!std::isnan(nodes(2, i))) defined.push_back(i);
                                    return defined;
                                }()),
                          xy);
}

/// Touches with the variant's error. @return 3xN
inline Eigen::Matrix3Xd touch(const Variant& variant, const Height& surface, const Eigen::Matrix2Xd& xy,
                              std::uint64_t seed)
{
    Eigen::Matrix3Xd touches(3, xy.cols());
    touches << xy, (heights(surface, xy) + sampling::draw_noise(variant.noise, xy.cols(), seed)).transpose();
    return touches;
}

/// Errors of griddata through touches and estimated points, in. Where the hull does not hold the place they are left
/// out, as the paper's Matlab leaves NaN out of max and min.
inline Eigen::VectorXd griddata_errors(const Variant& variant, const job::Job& job, const Height& truth,
                                       const Eigen::Matrix3Xd& touches, const Eigen::Matrix3Xd& estimated,
                                       std::uint64_t seed)
{
    const Eigen::Matrix3Xd corners =
        touch(variant, truth, variant.corners ? Eigen::Matrix2Xd(job.sampling.topRows<2>()) : Eigen::Matrix2Xd(2, 0),
              seed_of(seed, 4));
    Eigen::Matrix3Xd points(3, touches.cols() + estimated.cols() + corners.cols());
    points << touches, estimated, corners;
    job::Job region = job;
    if (variant.over_sampling) {
        region.anomaly = job.sampling;
        region.sampling = 2 * job.sampling; // has to hold it, and decides nothing
        region.sampling.topRows<2>().colwise() -= job.sampling.topRows<2>().rowwise().mean().eval();
    }
    const Eigen::Matrix2Xd places = margin::anomaly_grid(region, kPlacesAcross);
    const Eigen::VectorXd errors = variant_heights(variant, points, places) - heights(truth, places);
    return errors.unaryExpr([](double error) { return std::isnan(error) ? 0 : error; }) / kInch;
}

inline double size_of(const Variant& variant, const Eigen::VectorXd& errors)
{
    return variant.largest ? errors.cwiseAbs().maxCoeff() : margin::error_band(errors);
}

} // namespace fettle::study
