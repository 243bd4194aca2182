#include "fit/round_problem.h"

#include "fit/ceres_options.h"

#include <ceres/ceres.h>

#include <limits>

namespace fettle {

namespace {

// Both shapes in the coordinates d of the frame, moved by h along n0, in units of the touches' extent. With
//   q = k/2 |d_bent|² + n·d,   d_bent the part of d that the shape bends (all of it; across the axis),
// |d_bent + n/k|² k² = 1 + 2 k q is the squared distance from the centre (axis) over the radius, so the distance from
// the surface is (√(1 + 2kq) - 1)/k = 2q / (1 + √(1 + 2kq)), which has no cancellation and a limit for k → 0.
template <typename T>
bool distance(const T& k, const T& bent_squared, const T& n_d, T* residual)
{
    const T q = 0.5 * k * bent_squared + n_d;
    const T ratio = 1.0 + 2.0 * k * q;
    if (!(ratio > 0.0)) return false; // on the centre: the distance has no derivative
    *residual = 2.0 * q / (1.0 + sqrt(ratio));
    return true;
}

template <typename T>
using Vector3 = Eigen::Matrix<T, 3, 1>;

struct SphereDistance {
    static constexpr int kParameters = 4;
    Eigen::Vector3d touch;
    double scale;

    template <typename T>
    bool operator()(const T* theta, T* residual) const
    {
        const Vector3<T> n = Vector3<T>(theta[2], theta[1], T(1)).normalized();
        const Vector3<T> d = touch.cast<T>() - Vector3<T>(T(0), T(0), theta[0]);
        if (!distance<T>(theta[3], d.squaredNorm(), n.dot(d), residual)) return false;
        *residual *= scale;
        return true;
    }
};

struct CylinderDistance {
    static constexpr int kParameters = 5;
    Eigen::Vector3d touch;
    double scale;

    template <typename T>
    bool operator()(const T* theta, T* residual) const
    {
        const Vector3<T> a = Vector3<T>(T(1), theta[3], -theta[2]).normalized();
        const Vector3<T> up(T(0), theta[1], T(1));
        const Vector3<T> n = (up - up.dot(a) * a).normalized();
        const Vector3<T> d = touch.cast<T>() - Vector3<T>(T(0), T(0), theta[0]);
        const Vector3<T> across = d - d.dot(a) * a;
        if (!distance<T>(theta[4], across.squaredNorm(), n.dot(d), residual)) return false;
        *residual *= scale;
        return true;
    }
};

template <typename Distance>
RoundSolution solve(const RoundFrame& frame, const Eigen::Matrix3Xd& touches, double curvature, double width)
{
    constexpr int kParameters = Distance::kParameters;
    const Eigen::Matrix3Xd local = frame.axes.transpose() * (touches.colwise() - frame.point);
    const double extent = local.cwiseAbs().maxCoeff();
    RoundSolution solution;
    solution.parameters = Eigen::VectorXd::Zero(kParameters);
    solution.parameters[kParameters - 1] = curvature * extent;
    ceres::Problem problem;
    for (Eigen::Index i = 0; i < local.cols(); ++i)
        problem.AddResidualBlock(new ceres::AutoDiffCostFunction<Distance, 1, kParameters>(
                                     new Distance{local.col(i) / extent, extent / width}),
                                 new ceres::HuberLoss(1), solution.parameters.data());
    ceres::Solver::Options options = quiet_dense_qr();
    options.max_num_iterations = 200;
    options.function_tolerance = 1e-14;  // relative, of the cost: rounding of its sum
    options.parameter_tolerance = 1e-12; // of angles and of lengths over the extent
    options.gradient_tolerance = 1e-14;  // residuals are in units of the touch error
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    solution.cost = summary.IsSolutionUsable() ? summary.final_cost : std::numeric_limits<double>::infinity();
    solution.converged = summary.termination_type == ceres::CONVERGENCE;
    solution.iterations = static_cast<int>(summary.iterations.size());
    solution.parameters[0] *= extent;
    solution.parameters[kParameters - 1] /= extent;
    return solution;
}

} // namespace

RoundSolution solve_sphere(const RoundFrame& frame, const Eigen::Matrix3Xd& touches, double curvature, double width)
{
    return solve<SphereDistance>(frame, touches, curvature, width);
}

RoundSolution solve_cylinder(const RoundFrame& frame, const Eigen::Matrix3Xd& touches, double curvature, double width)
{
    return solve<CylinderDistance>(frame, touches, curvature, width);
}

} // namespace fettle
