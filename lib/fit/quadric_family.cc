#include "fit/quadric_family.h"

#include "fit/tiny_least_squares.h"
#include "surface/quadratic.h"
#include "surface/shapes.h"

#include <Eigen/Cholesky>

#include <cmath>

namespace fettle {

namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr int kParameters = 9;
using Parameters = Eigen::Matrix<double, kParameters, 1>;

/// Where the touches are seen from: a point of the paraboloid, its third axis the normal there; lengths are in units
/// of `extent`.
struct Frame {
    Vector3d point; ///< M, mm
    Matrix3d axes;  ///< columns
    double extent;  ///< mm
};

/// ½ dᵀ A d + g·d - c, in the frame.
struct Form {
    Matrix3d A;
    Vector3d g;
    double c;

    explicit Form(const Parameters& theta) : g(theta[1], theta[2], 1), c(theta[0])
    {
        A << theta[3], theta[4], theta[6], theta[4], theta[5], theta[7], theta[6], theta[7], theta[8];
    }
    /// From a point along a direction to where the form rises through 0; NaN if it does not.
    double distance(const Vector3d& from, const Vector3d& along) const
    {
        const Vector3d Ad = A * from;
        return rising_root(along.dot(A * along) / 2, along.dot(Ad + g), from.dot(Ad) / 2 + g.dot(from) - c);
    }
    Vector3d gradient(const Vector3d& d) const { return A * d + g; }
};

/// ∂/∂θ of the form at a point of it.
Parameters by_parameters(const Vector3d& d)
{
    Parameters F_theta;
    F_theta << -1, d[0], d[1], d[0] * d[0] / 2, d[1] * d[0], d[1] * d[1] / 2, d[2] * d[0], d[2] * d[1], d[2] * d[2] / 2;
    return F_theta;
}

/// Touch less surface over σ. With F(d + t e_z; θ) = 0 it is ∂t/∂θ = -F_θ / F_z.
struct VerticalErrors {
    Eigen::Matrix3Xd points; ///< in the frame
    Vector3d up;             ///< e_z
    double weight;           ///< extent over σ

    void operator()(const double* x, double* residuals, double* jacobian) const
    {
        constexpr double kFar = 1e6; // no surface over a touch: so bad that the step is taken back
        const Form form{Parameters(Eigen::Map<const Parameters>(x))};
        for (Index i = 0; i < points.cols(); ++i) {
            const double t = form.distance(points.col(i), up);
            residuals[i] = std::isnan(t) ? weight * kFar : -weight * t;
            if (jacobian == nullptr) continue;
            const Vector3d d = points.col(i) + t * up;
            const Parameters by = by_parameters(d) * (weight / up.dot(form.gradient(d)));
            for (int k = 0; k < kParameters; ++k) jacobian[k * points.cols() + i] = std::isnan(t) ? 0 : by[k];
        }
    }
};

/// The polynomial as a quadric: z - q(x, y) over the length of its gradient.
Parameters start(const Polynomial& paraboloid, const Frame& frame)
{
    const Eigen::VectorXd& c = paraboloid.coefficients;
    Matrix3d form = Matrix3d::Zero();
    form.topLeftCorner<2, 2>() << -2 * c[3], -c[4], -c[4], -2 * c[5];
    form *= frame.axes(2, 2) * frame.extent / (paraboloid.scale * paraboloid.scale);
    const Matrix3d A = frame.axes.transpose() * form * frame.axes;
    return (Parameters() << 0, 0, 0, A(0, 0), A(1, 0), A(1, 1), A(2, 0), A(2, 1), A(2, 2)).finished();
}

Frame frame_of(const Polynomial& paraboloid, const Eigen::Matrix3Xd& touches)
{
    Frame frame;
    const Eigen::Vector2d slope = fettle::slope(paraboloid, paraboloid.origin);
    frame.point << paraboloid.origin, paraboloid.coefficients[0];
    frame.axes.col(2) = Vector3d(-slope.x(), -slope.y(), 1).normalized();
    frame.axes.col(0) = tangents(frame.axes.col(2))[0];
    frame.axes.col(1) = tangents(frame.axes.col(2))[1];
    frame.extent = (touches.colwise() - frame.point).colwise().norm().maxCoeff();
    return frame;
}

/// Does the form's gradient keep its size over the touches, and do they tell it? Through nearly flat touches pass
/// quadrics of any kind, which bend away between them: pairs of planes, needles.
bool is_determined(const Form& form, const VerticalErrors& errors, const Eigen::Matrix3Xd& all, const Parameters& x)
{
    constexpr double kMostChange = 3;  // times as large or as small as in the middle
    constexpr double kMostSpread = .3; // of the gradient's size: errors are propagated as if it were known
    Eigen::Matrix<double, Eigen::Dynamic, kParameters> J(errors.points.cols(), kParameters);
    Eigen::VectorXd residuals(errors.points.cols());
    errors(x.data(), residuals.data(), J.data());
    const Eigen::LDLT<Eigen::Matrix<double, kParameters, kParameters>> information(J.transpose() * J);
    for (const Vector3d& touch : all.colwise()) {
        const Vector3d d = touch + form.distance(touch, errors.up) * errors.up;
        const double size = form.gradient(d).norm() / form.g.norm();
        Parameters by = Parameters::Zero(); // of the gradient's third component, by the form's third row
        by.tail<3>() = d;
        const double variance = by.dot(information.solve(by));
        if (!(size > 1 / kMostChange && size < kMostChange && variance < kMostSpread * kMostSpread)) return false;
    }
    return true;
}

} // namespace

std::optional<FamilySolution> solve_quadric(const Touched& touched, const Columns& kept, const Polynomial& paraboloid)
{
    if (kept.size() < kParameters) return std::nullopt;
    const Frame frame = frame_of(paraboloid, touched.xyz);
    const Eigen::Matrix3Xd all = frame.axes.transpose() * (touched.xyz.colwise() - frame.point) / frame.extent;
    const VerticalErrors errors{all(Eigen::all, kept), frame.axes.row(2), frame.extent / touched.sigma};
    const Minimum best =
        least_squares({static_cast<int>(kept.size()), kParameters, std::cref(errors)}, start(paraboloid, frame));
    const Form form{Parameters(best.x)};
    if (!best.x.allFinite() || !is_determined(form, errors, all, best.x)) return std::nullopt;
    const Vector3d d = form.distance(Vector3d::Zero(), errors.up) * errors.up;
    const Vector3d gradient = form.gradient(d);
    if (!gradient.allFinite()) return std::nullopt;
    FamilySolution result;
    result.shape = Quadric{frame.point + frame.extent * frame.axes * d, frame.axes * gradient.normalized(),
                           frame.axes * form.A * frame.axes.transpose() / (gradient.norm() * frame.extent)};
    result.gradients = height_gradients(result.shape, touched.xyz.topRows(2));
    result.converged = best.converged;
    result.iterations = best.iterations;
    return result;
}

} // namespace fettle
