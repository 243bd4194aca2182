#include "merge/pose_graph.h"

#include "core/decompositions.h"

#include <ceres/ceres.h>
#include <ceres/rotation.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>

namespace fettle::merge {
namespace {

using Blocks = std::vector<std::array<double, 6>>; ///< twists ξ of the scans: shift, then rotation vector times radius

// An eigenvalue below this share of the largest is rounding: the pair does not determine that motion.
constexpr double kMinEigenvalueShare = 1e-10;

template <typename T>
using Vector3 = Eigen::Matrix<T, 3, 1>;

template <typename T>
struct Motion {
    Eigen::Quaternion<T> rotation;
    Vector3<T> shift; ///< p ↦ rotation p + shift
};

/// Pose of a scan after the twist ξ about its centre.
template <typename T>
Motion<T> moved(const Eigen::Isometry3d& pose, const align::TwistFrame& frame, const T* twist)
{
    const T angle_axis[3] = {twist[3] / frame.radius, twist[4] / frame.radius, twist[5] / frame.radius};
    T q[4];
    ceres::AngleAxisToQuaternion(angle_axis, q);
    const Eigen::Quaternion<T> turn(q[0], q[1], q[2], q[3]);
    const Vector3<T> centre = (pose * frame.centre).cast<T>();
    const Vector3<T> from_centre = pose.translation().cast<T>() - centre;
    return {turn * Eigen::Quaterniond(pose.linear()).cast<T>(),
            turn * from_centre + centre + Eigen::Map<const Vector3<T>>(twist)};
}

/// Residual of an edge. With the pose D = T_b⁻¹ T_a M⁻¹ that leads from the measured pose M to that of the graph, and
/// the edge's centre c and radius ρ,
///   x = (D c - c, ρ log(rotation of D)),   r = Sᵀ x,   S Sᵀ = information.
struct EdgeCost {
    Eigen::Isometry3d pose_a, pose_b;
    align::TwistFrame frame_a, frame_b;
    const PoseEdge* edge;
    align::TwistMatrix root; ///< Sᵀ

    template <typename T>
    bool operator()(const T* twist_a, const T* twist_b, T* residuals) const
    {
        const Motion<T> a = moved(pose_a, frame_a, twist_a), b = moved(pose_b, frame_b, twist_b);
        const Eigen::Isometry3d measured_inverse = edge->T_b_a.inverse();
        const Eigen::Quaternion<T> D =
            b.rotation.conjugate() * a.rotation * Eigen::Quaterniond(measured_inverse.linear()).cast<T>();
        const Eigen::Vector3d in_a = measured_inverse * edge->frame.centre;
        const Vector3<T> in_world = a.rotation * in_a.cast<T>() + a.shift;
        const Vector3<T> in_b = b.rotation.conjugate() * (in_world - b.shift);
        const T q[4] = {D.w(), D.x(), D.y(), D.z()};
        T angle_axis[3];
        ceres::QuaternionToAngleAxis(q, angle_axis);
        Eigen::Matrix<T, 6, 1> x;
        x.template head<3>() = in_b - edge->frame.centre.cast<T>();
        for (int k = 0; k < 3; ++k) x[3 + k] = angle_axis[k] * edge->frame.radius;
        Eigen::Map<Eigen::Matrix<T, 6, 1>>(residuals).noalias() = root.cast<T>() * x;
        return true;
    }
};

/// Sᵀ with S Sᵀ = A, for a semidefinite A.
align::TwistMatrix root_of(const align::TwistMatrix& A)
{
    const auto [values, vectors] = core::symmetric_eigen<6>(A);
    const double min_value = kMinEigenvalueShare * std::max(values[5], 0.0);
    Eigen::Matrix<double, 6, 1> roots;
    for (int k = 0; k < 6; ++k) roots[k] = values[k] > min_value ? std::sqrt(values[k]) : 0;
    return roots.asDiagonal() * vectors.transpose();
}

/// Whether the edges determine all motions: Ceres would complain on stderr.
bool is_determined(ceres::Problem& problem, Blocks& twists, std::size_t fixed)
{
    constexpr double kMinReciprocalCondition = 1e-11; // of JᵀJ; Ceres refuses 1e-14
    ceres::Problem::EvaluateOptions options;
    options.apply_loss_function = false;
    for (std::size_t i = 0; i < twists.size(); ++i)
        if (i != fixed) options.parameter_blocks.push_back(twists[i].data());
    ceres::CRSMatrix sparse;
    problem.Evaluate(options, nullptr, nullptr, nullptr, &sparse);
    Eigen::MatrixXd J = Eigen::MatrixXd::Zero(sparse.num_rows, sparse.num_cols);
    for (int row = 0; row < sparse.num_rows; ++row)
        for (int k = sparse.rows[row]; k < sparse.rows[row + 1]; ++k) J(row, sparse.cols[k]) = sparse.values[k];
    const auto values = core::symmetric_eigen<Eigen::Dynamic>(J.transpose() * J).values;
    return values.size() == 0 || values[0] > kMinReciprocalCondition * values[values.size() - 1];
}

std::optional<std::vector<align::TwistMatrix>> covariances_of(ceres::Problem& problem, Blocks& twists,
                                                              std::size_t fixed)
{
    if (!is_determined(problem, twists, fixed)) return std::nullopt;
    ceres::Covariance::Options options;
    options.num_threads = 1;
    options.apply_loss_function = false; // of the edges as they are stated
    options.algorithm_type = ceres::DENSE_SVD;
    options.null_space_rank = 0; // an undetermined motion is an error, not left out
    ceres::Covariance covariance(options);
    std::vector<std::pair<const double*, const double*>> blocks;
    for (std::size_t i = 0; i < twists.size(); ++i)
        if (i != fixed) blocks.emplace_back(twists[i].data(), twists[i].data());
    std::vector<align::TwistMatrix> found(twists.size(), align::TwistMatrix::Zero());
    if (!blocks.empty() && !covariance.Compute(blocks, &problem)) return std::nullopt;
    for (std::size_t i = 0; i < twists.size(); ++i) {
        if (i == fixed) continue;
        Eigen::Matrix<double, 6, 6, Eigen::RowMajor> block;
        covariance.GetCovarianceBlock(twists[i].data(), twists[i].data(), block.data());
        found[i] = block;
    }
    return found;
}

} // namespace

PoseGraphSolution solve_pose_graph(const PoseGraph& graph, double robust_width)
{
    const std::size_t count = graph.T_world_scan.size();
    Blocks twists(count, std::array<double, 6>{});
    ceres::Problem problem;
    for (auto& twist : twists) problem.AddParameterBlock(twist.data(), 6);
    problem.SetParameterBlockConstant(twists[graph.fixed].data());
    std::vector<std::unique_ptr<ceres::CostFunction>> costs; // evaluated again below, without the loss
    for (const PoseEdge& edge : graph.edges) {
        const auto make = [&] {
            return new ceres::AutoDiffCostFunction<EdgeCost, 6, 6, 6>(
                new EdgeCost{graph.T_world_scan[edge.a], graph.T_world_scan[edge.b], graph.frames[edge.a],
                             graph.frames[edge.b], &edge, root_of(edge.information)});
        };
        costs.emplace_back(make());
        problem.AddResidualBlock(make(), robust_width > 0 ? new ceres::CauchyLoss(robust_width) : nullptr,
                                 twists[edge.a].data(), twists[edge.b].data());
    }
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_QR; // information of a pair may be nearly singular
    options.logging_type = ceres::SILENT;
    options.num_threads = 1; // a fixed order of sums
    constexpr int kMaxIterations = 100;
    options.max_num_iterations = kMaxIterations;
    constexpr double kTolerance = 1e-12; // steps far below the standard deviations
    options.function_tolerance = options.parameter_tolerance = kTolerance;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);

    PoseGraphSolution solution;
    solution.converged = summary.termination_type == ceres::CONVERGENCE;
    for (std::size_t i = 0; i < count; ++i) {
        const Motion<double> pose = moved(graph.T_world_scan[i], graph.frames[i], twists[i].data());
        Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
        T.linear() = pose.rotation.normalized().toRotationMatrix();
        T.translation() = pose.shift;
        solution.T_world_scan.push_back(T);
    }
    for (std::size_t e = 0; e < graph.edges.size(); ++e) {
        const double* const blocks[] = {twists[graph.edges[e].a].data(), twists[graph.edges[e].b].data()};
        align::Twist residual;
        costs[e]->Evaluate(blocks, residual.data(), nullptr);
        solution.misfits.push_back(residual.norm());
    }
    solution.covariances = covariances_of(problem, twists, graph.fixed);
    return solution;
}

} // namespace fettle::merge
