#include "fit/quadric_family.h"

#include "fit/tiny_least_squares.h"
#include "surface/quadratic.h"
#include "surface/shapes.h"

#include <Eigen/Cholesky>

#include <cmath>

namespace fettle::fit {

namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr int kParameters = 9;
using Parameters = Eigen::Matrix<double, kParameters, 1>;

/// Frame of the quadric's parameters: the origin is a point of the paraboloid, the third axis its normal there.
struct Frame {
    Vector3d point; ///< M, mm
    Matrix3d axes;  ///< columns
    double extent;  ///< unit of length, mm
};

/// The quadratic form F(d) = ½ dᵀ A d + g·d - c in the frame.
struct Form {
    Matrix3d A;
    Vector3d g;
    double c;

    explicit Form(const Parameters& theta) : g(theta[1], theta[2], 1), c(theta[0])
    {
        A << theta[3], theta[4], theta[6], theta[4], theta[5], theta[7], theta[6], theta[7], theta[8];
    }
    /// Signed distance from a point along a direction to where F rises through 0; NaN if it does not.
    double distance(const Vector3d& from, const Vector3d& along) const
    {
        const Vector3d Ad = A * from;
        return surface::increasing_root(along.dot(A * along) / 2, along.dot(Ad + g),
                                        from.dot(Ad) / 2 + g.dot(from) - c);
    }
    Vector3d gradient(const Vector3d& d) const { return A * d + g; }
};

/// ∂F/∂θ at a point.
Parameters parameter_gradient(const Vector3d& d)
{
    Parameters F_theta;
    F_theta << -1, d[0], d[1], d[0] * d[0] / 2, d[1] * d[0], d[1] * d[1] / 2, d[2] * d[0], d[2] * d[1], d[2] * d[2] / 2;
    return F_theta;
}

/// Heights of the touches above the surface over σ, -t/σ with F(d + t e_z; θ) = 0; ∂t/∂θ = -F_θ / F_z.
struct VerticalErrors {
    Eigen::Matrix3Xd points; ///< in the frame
    Vector3d up;             ///< e_z
    double weight;           ///< extent over σ

    void operator()(const double* x, double* residuals, double* jacobian) const
    {
        constexpr double kRejectedError = 1e6; // no surface over a touch: makes the solver reject the step
        const Form form{Parameters(Eigen::Map<const Parameters>(x))};
        for (Index i = 0; i < points.cols(); ++i) {
            const double t = form.distance(points.col(i), up);
            residuals[i] = std::isnan(t) ? weight * kRejectedError : -weight * t;
            if (jacobian == nullptr) continue;
            const Vector3d d = points.col(i) + t * up;
            const Parameters slope = parameter_gradient(d) * (weight / up.dot(form.gradient(d)));
            for (int k = 0; k < kParameters; ++k) jacobian[k * points.cols() + i] = std::isnan(t) ? 0 : slope[k];
        }
    }
};

/// The paraboloid's parameters as a quadric: (z - q(x, y)) / |gradient|.
Parameters initial_parameters(const surface::Polynomial& paraboloid, const Frame& frame)
{
    const Eigen::VectorXd& c = paraboloid.coefficients;
    Matrix3d form = Matrix3d::Zero();
    form.topLeftCorner<2, 2>() << -2 * c[3], -c[4], -c[4], -2 * c[5];
    form *= frame.axes(2, 2) * frame.extent / (paraboloid.scale * paraboloid.scale);
    const Matrix3d A = frame.axes.transpose() * form * frame.axes;
    return (Parameters() << 0, 0, 0, A(0, 0), A(1, 0), A(1, 1), A(2, 0), A(2, 1), A(2, 2)).finished();
}

Frame make_frame(const surface::Polynomial& paraboloid, const Eigen::Matrix3Xd& touches)
{
    Frame frame;
    const Eigen::Vector2d slope = fettle::surface::slope(paraboloid, paraboloid.origin);
    frame.point << paraboloid.origin, paraboloid.coefficients[0];
    frame.axes.col(2) = Vector3d(-slope.x(), -slope.y(), 1).normalized();
    frame.axes.col(0) = surface::tangents(frame.axes.col(2))[0];
    frame.axes.col(1) = surface::tangents(frame.axes.col(2))[1];
    frame.extent = (touches.colwise() - frame.point).colwise().norm().maxCoeff();
    return frame;
}

/// True if the form's gradient is about constant over the touches and known well. Nearly flat touches are fitted by
/// quadrics of any kind that bend away between them, such as pairs of planes and needles.
bool is_determined(const Form& form, const VerticalErrors& errors, const Eigen::Matrix3Xd& all, const Parameters& x)
{
    constexpr double kMaxGradientRatio = 3;  // to the one at the frame's origin, and vice versa
    constexpr double kMaxGradientSigma = .3; // relative: errors are propagated as if the gradient were known
    Eigen::Matrix<double, Eigen::Dynamic, kParameters> J(errors.points.cols(), kParameters);
    Eigen::VectorXd residuals(errors.points.cols());
    errors(x.data(), residuals.data(), J.data());
    const Eigen::LDLT<Eigen::Matrix<double, kParameters, kParameters>> information(J.transpose() * J);
    for (const Vector3d& touch : all.colwise()) {
        const Vector3d d = touch + form.distance(touch, errors.up) * errors.up;
        const double size = form.gradient(d).norm() / form.g.norm();
        Parameters by_theta = Parameters::Zero(); // of the gradient's third component
        by_theta.tail<3>() = d;
        const double variance = by_theta.dot(information.solve(by_theta));
        if (!(size > 1 / kMaxGradientRatio && size < kMaxGradientRatio &&
              variance < kMaxGradientSigma * kMaxGradientSigma))
            return false;
    }
    return true;
}

} // namespace

std::optional<FamilySolution> solve_quadric(const TouchSet& touched, const TouchIndices& kept,
                                            const surface::Polynomial& paraboloid)
{
    if (kept.size() < kParameters) return std::nullopt;
    const Frame frame = make_frame(paraboloid, touched.xyz);
    const Eigen::Matrix3Xd all = frame.axes.transpose() * (touched.xyz.colwise() - frame.point) / frame.extent;
    const VerticalErrors errors{all(Eigen::all, kept), frame.axes.row(2), frame.extent / touched.sigma};
    const Minimum best = levenberg_marquardt({static_cast<int>(kept.size()), kParameters, std::cref(errors)},
                                             initial_parameters(paraboloid, frame));
    const Form form{Parameters(best.x)};
    if (!best.x.allFinite() || !is_determined(form, errors, all, best.x)) return std::nullopt;
    const Vector3d d = form.distance(Vector3d::Zero(), errors.up) * errors.up;
    const Vector3d gradient = form.gradient(d);
    if (!gradient.allFinite()) return std::nullopt;
    FamilySolution result;
    result.shape = surface::Quadric{frame.point + frame.extent * frame.axes * d, frame.axes * gradient.normalized(),
                                    frame.axes * form.A * frame.axes.transpose() / (gradient.norm() * frame.extent)};
    result.gradients = surface::height_gradients(result.shape, touched.xyz.topRows(2));
    result.converged = best.converged;
    result.iterations = best.iterations;
    return result;
}

} // namespace fettle::fit
