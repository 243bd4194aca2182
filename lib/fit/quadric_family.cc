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
/// Columns span the forms of a family: its parameters times this are those of a quadric.
using Basis = Eigen::Matrix<double, kParameters, Eigen::Dynamic>;

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
    Basis basis;

    void operator()(const double* x, double* residuals, double* jacobian) const
    {
        constexpr double kRejectedError = 1e6; // no surface over a touch: makes the solver reject the step
        const Form form{basis * Eigen::Map<const Eigen::VectorXd>(x, basis.cols())};
        for (Index i = 0; i < points.cols(); ++i) {
            const double t = form.distance(points.col(i), up);
            residuals[i] = std::isnan(t) ? weight * kRejectedError : -weight * t;
            if (jacobian == nullptr) continue;
            const Vector3d d = points.col(i) + t * up;
            const Eigen::VectorXd slope =
                basis.transpose() * parameter_gradient(d) * (weight / up.dot(form.gradient(d)));
            for (Index k = 0; k < basis.cols(); ++k) jacobian[k * points.cols() + i] = std::isnan(t) ? 0 : slope[k];
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
    // The centroid: a family that is told by this normal turns with the touches.
    const Eigen::Vector2d middle = touches.topRows<2>().rowwise().mean();
    const Eigen::Vector2d slope = fettle::surface::slope(paraboloid, middle);
    frame.point << middle, surface::height(paraboloid, middle);
    frame.axes.col(2) = Vector3d(-slope.x(), -slope.y(), 1).normalized();
    frame.axes.col(0) = surface::tangents(frame.axes.col(2))[0];
    frame.axes.col(1) = surface::tangents(frame.axes.col(2))[1];
    frame.extent = (touches.colwise() - frame.point).colwise().norm().maxCoeff();
    return frame;
}

/// True if the form's gradient is about constant over the touches and known well. Nearly flat touches are fitted by
/// quadrics of any kind that bend away between them, such as pairs of planes and needles.
bool is_determined(const Form& form, const VerticalErrors& errors, const Eigen::Matrix3Xd& all,
                   const Eigen::VectorXd& x)
{
    constexpr double kMaxGradientRatio = 3;  // to the one at the frame's origin, and vice versa
    constexpr double kMaxGradientSigma = .3; // relative: errors are propagated as if the gradient were known
    Eigen::MatrixXd J(errors.points.cols(), x.size());
    Eigen::VectorXd residuals(errors.points.cols());
    errors(x.data(), residuals.data(), J.data());
    const Eigen::LDLT<Eigen::MatrixXd> information(J.transpose() * J);
    for (const Vector3d& touch : all.colwise()) {
        const Vector3d d = touch + form.distance(touch, errors.up) * errors.up;
        const double size = form.gradient(d).norm() / form.g.norm();
        Parameters by_theta = Parameters::Zero(); // of the gradient's third component
        by_theta.tail<3>() = d;
        const Eigen::VectorXd by_x = errors.basis.transpose() * by_theta;
        const double variance = by_x.dot(information.solve(by_x));
        if (!(size > 1 / kMaxGradientRatio && size < kMaxGradientRatio &&
              variance < kMaxGradientSigma * kMaxGradientSigma))
            return false;
    }
    return true;
}

/// The forms of ellipsoids: no mixed terms with the normal, and along it the mean of the curvatures across.
Basis ellipsoid_basis()
{
    Basis basis = Basis::Zero(kParameters, 6);
    basis.topLeftCorner<6, 6>().setIdentity();
    basis(8, 3) = basis(8, 5) = 0.5;
    return basis;
}

/// Changes of a shape's parameters by those of a family's. About a point p of the surface, with e = d - p, a change of
/// the form is ½ eᵀ δA e + v·e + K. The shape's offset, -K, moves the gradient by K A n; its gradient keeps length 1,
/// so that the rest of v along n scales the form instead.
Eigen::MatrixXd free_directions(const Form& form, const Vector3d& point, const Frame& frame, const Basis& basis)
{
    const Vector3d gradient = form.gradient(point);
    const double size = gradient.norm();
    const Vector3d normal = frame.axes * gradient / size;
    Matrix3d axes; // of the shape's parameters, M
    axes << surface::tangents(normal)[0], surface::tangents(normal)[1], normal;
    const Matrix3d turn = axes.transpose() * frame.axes;
    const Matrix3d A = turn * form.A * turn.transpose() / size;
    Eigen::MatrixXd directions(kParameters, basis.cols());
    for (Index k = 0; k < basis.cols(); ++k) {
        Form change{Parameters(basis.col(k))};
        change.g.z() = 0; // that of a form is 1
        const double K = (point.dot(change.A * point) / 2 + change.g.dot(point) - change.c) / size;
        const Vector3d v = turn * change.gradient(point) / size - K * A.col(2);
        const Matrix3d B = turn * change.A * turn.transpose() / size - v.z() * A;
        directions.col(k) << -K * frame.extent, v.x(), v.y(),
            Eigen::Matrix<double, 6, 1>(B(0, 0), B(1, 0), B(1, 1), B(2, 0), B(2, 1), B(2, 2)) / frame.extent;
    }
    return directions;
}

std::optional<FamilySolution> solve(const TouchSet& touched, const TouchIndices& kept,
                                    const surface::Polynomial& paraboloid, const Basis& basis)
{
    if (Index(kept.size()) < basis.cols()) return std::nullopt;
    const Frame frame = make_frame(paraboloid, touched.xyz);
    const Eigen::Matrix3Xd all = frame.axes.transpose() * (touched.xyz.colwise() - frame.point) / frame.extent;
    const VerticalErrors errors{all(Eigen::all, kept), frame.axes.row(2), frame.extent / touched.sigma, basis};
    // The identity stands in the rows of a family's free parameters, which come first.
    const ResidualFunction residuals{static_cast<int>(kept.size()), static_cast<int>(basis.cols()), std::cref(errors)};
    Minimum best = levenberg_marquardt(residuals, initial_parameters(paraboloid, frame).head(basis.cols()));
    best.x = refine_minimum(residuals, best.x);
    if (!best.x.allFinite()) return std::nullopt;
    const Form form{Parameters(basis * best.x)};
    if (!is_determined(form, errors, all, best.x)) return std::nullopt;
    const Vector3d d = form.distance(Vector3d::Zero(), errors.up) * errors.up;
    const Vector3d gradient = form.gradient(d);
    if (!gradient.allFinite()) return std::nullopt;
    FamilySolution result;
    result.shape = surface::Quadric{frame.point + frame.extent * frame.axes * d, frame.axes * gradient.normalized(),
                                    frame.axes * form.A * frame.axes.transpose() / (gradient.norm() * frame.extent)};
    result.gradients = surface::height_gradients(result.shape, touched.xyz.topRows(2));
    if (basis.cols() < kParameters) result.free_directions = free_directions(form, d, frame, basis);
    result.converged = best.converged;
    result.iterations = best.iterations;
    return result;
}

} // namespace

std::optional<FamilySolution> solve_quadric(const TouchSet& touched, const TouchIndices& kept,
                                            const surface::Polynomial& paraboloid)
{
    return solve(touched, kept, paraboloid, Basis::Identity(kParameters, kParameters));
}

std::optional<FamilySolution> solve_ellipsoid(const TouchSet& touched, const TouchIndices& kept,
                                              const surface::Polynomial& paraboloid)
{
    return solve(touched, kept, paraboloid, ellipsoid_basis());
}

} // namespace fettle::fit
