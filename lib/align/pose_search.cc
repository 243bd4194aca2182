#include "align/pose_search.h"

#include "align/point_pairs.h"
#include "core/decompositions.h"
#include "geometry/bounding_box.h"
#include "geometry/point_index.h"
#include "geometry/quantiles.h"

#include <Eigen/Core>
#include <tbb/parallel_for.h>

#include <cmath>
#include <numbers>
#include <numeric>

namespace fettle::align {

namespace {

constexpr Eigen::Index kScanSamples = 160;       // scan points used in a descent
constexpr Eigen::Index kReferenceSamples = 4000; // reference points in the lookup grid
// Reference points from which samples are drawn: more would take longer and lie no more evenly.
constexpr Eigen::Index kMaxReferencePoints = 50000;
// Every rotation is within some 20° of one of 1000 start rotations and within 35° of one of 200; a descent converges
// from about 40° away. With many start positions each gets fewer rotations, to bound the number of descents.
constexpr int kMaxRotations = 1000, kMinRotations = 200, kMaxDescents = 6000;
constexpr int kRotationsAboutAxis = 36;
constexpr int kDescentSteps = 24;
constexpr int kStepsAtFinalWidth = 4;
// Width of the robust kernel, in scan radii: it starts wide enough for all nearby points and ends at the cell size of
// the lookup grid.
constexpr double kInitialWidthRadii = 0.5, kFinalWidthRadii = 0.06;
// The poses that match_point_pairs() finds are nearly right: a wider kernel would draw them towards neighbouring
// objects.
constexpr double kMatchInitialWidthRadii = 0.15;
// Weight of the residual along the tangent plane of a foot, relative to the residual along its normal: 1 in the first
// step, falling linearly at this rate to the minimum, which it reaches after two thirds of the steps.
constexpr double kTangentialDecay = 1.5, kMinTangentialWeight = 0.02;
// Directions whose eigenvalue is below this fraction of the trace of the normal matrix are not constrained by any
// correspondence. The pose does not move along them.
constexpr double kMinEigenvalueToTrace = 1e-6;
// Two poses closer than this, in scan radii, are duplicates.
constexpr double kDuplicateCandidateRadii = 0.15;
constexpr std::size_t kMaxPoses = 32;

/// Voxel grid around the reference that stores the nearest reference point of each cell centre. A lookup is exact to a
/// cell; it is an array access, where a k-d tree would be searched once for each point in each step of each descent.
class NearestPointGrid {
  public:
    /// @param margin  by which the grid extends beyond the reference's bounding box, mm
    NearestPointGrid(const OrientedPoints& reference, double margin) : points_(reference)
    {
        const Eigen::AlignedBox3d box = geometry::finite_bounding_box(reference.xyz);
        constexpr double kCellsAlongLongestSide = 56;
        min_ = box.min().array() - margin;
        const Eigen::Array3d size = box.sizes() + Eigen::Vector3d::Constant(2 * margin);
        cell_ = size.maxCoeff() / kCellsAlongLongestSide;
        cells_ = (size / cell_).ceil().cast<int>().max(1);
        nearest_.resize(cells_.prod());
        const geometry::PointIndex<3> neighbours(reference.xyz);
        std::vector<double> spacing(reference.xyz.cols());
        tbb::parallel_for(Eigen::Index{0}, reference.xyz.cols(), [&](Eigen::Index i) {
            const Eigen::Vector3d p = reference.xyz.col(i);
            spacing[i] = (reference.xyz.col(neighbours.nearest(p, 2).back()) - p).norm();
        });
        disc_radius_ = geometry::median(spacing) + cell_;
        tbb::parallel_for(0, cells_[2], [&](int k) {
            for (int j = 0; j < cells_[1]; ++j)
                for (int i = 0; i < cells_[0]; ++i) {
                    const Eigen::Array3d centre = min_ + (Eigen::Array3d(i, j, k) + 0.5) * cell_;
                    nearest_[index({i, j, k})] = neighbours.nearest(centre, 1).front();
                }
        });
    }

    /// Index of the reference point nearest to `p`; a point outside the grid gets that of the closest cell.
    Eigen::Index nearest(const Eigen::Vector3d& p) const
    {
        const Eigen::Array3d cell = ((p.array() - min_) / cell_).max(0.0).min((cells_ - 1).cast<double>());
        return nearest_[index(cell.cast<int>())];
    }

    Eigen::Vector3d normal(Eigen::Index i) const { return points_.normals.col(i); }

    /// Vector to `p` from the closest point of the disc around reference point i. The disc lies in the tangent plane
    /// and is as wide as the lookup may be wrong along the surface.
    Eigen::Vector3d offset_from_disc(Eigen::Index i, const Eigen::Vector3d& p) const
    {
        const Eigen::Vector3d n = normal(i), offset = p - points_.xyz.col(i);
        if (n.isZero(0)) return offset;
        const Eigen::Vector3d across = n.dot(offset) * n, tangential = offset - across;
        const double length = tangential.norm();
        return length > disc_radius_ ? Eigen::Vector3d(across + (1 - disc_radius_ / length) * tangential) : across;
    }

  private:
    std::size_t index(const Eigen::Array3i& cell) const
    {
        return (cell[2] * cells_[1] + cell[1]) * cells_[0] + cell[0];
    }

    const OrientedPoints& points_;
    Eigen::Array3d min_;                // corner of the grid, mm
    double cell_ = 0, disc_radius_ = 0; // mm
    Eigen::Array3i cells_;              // along x, y, z
    std::vector<std::int32_t> nearest_;
};

// Mean of the smallest values. @param share  of the values
double trimmed_mean(std::vector<double> values, double share)
{
    const auto count = std::clamp<std::size_t>(std::ceil(share * values.size()), 1, values.size());
    std::sort(values.begin(), values.end());
    return std::accumulate(values.begin(), values.begin() + count, 0.0) / count;
}

// Iteratively re-weighted Gauss-Newton with the Geman-McClure kernel, whose width shrinks from step to step (graduated
// non-convexity, as in Zhou, Park & Koltun, Fast Global Registration, 2016). The residual changes from point-to-point
// to point-to-plane on the way: the first steps bring the scan close, the last ones let it slide along the surface.
// @param initial_width  of the kernel, mm
PoseCandidate refine_pose(Eigen::Isometry3d T, const Eigen::Matrix3Xd& scan, const TwistFrame& scan_frame,
                          const NearestPointGrid& grid, const IcpOptions& options, double initial_width)
{
    const double radius = scan_frame.radius;
    const double final_width = std::clamp(options.max_distance.value_or(0), kFinalWidthRadii * radius, initial_width);
    std::vector<double> costs(scan.cols());
    for (int step = 0; step <= kDescentSteps; ++step) {
        const double progress = std::min(1.0, step / double(kDescentSteps - kStepsAtFinalWidth));
        const double width = initial_width * std::pow(final_width / initial_width, progress);
        const double tangential_weight = std::max(kMinTangentialWeight, 1 - kTangentialDecay * progress);
        const Eigen::Matrix3Xd moved_scan = T * scan;
        const TwistFrame frame{T * scan_frame.centre, radius};
        TwistMatrix A = TwistMatrix::Zero();
        Twist b = Twist::Zero();
        for (Eigen::Index i = 0; i < scan.cols(); ++i) {
            const Eigen::Vector3d p = moved_scan.col(i);
            const Eigen::Index foot = grid.nearest(p);
            const Eigen::Vector3d residual = grid.offset_from_disc(foot, p), normal = grid.normal(foot);
            const double squared_ratio = residual.squaredNorm() / (width * width);
            costs[i] = squared_ratio / (1 + squared_ratio);
            const double weight = 1 / ((1 + squared_ratio) * (1 + squared_ratio));
            const Eigen::Matrix3d M = weight * (tangential_weight * Eigen::Matrix3d::Identity() +
                                                (1 - tangential_weight) * normal * normal.transpose());
            Eigen::Matrix<double, 3, 6> J;
            const Eigen::Vector3d lever = (p - frame.centre) / radius;
            J << Eigen::Matrix3d::Identity(), //
                Eigen::Matrix3d{{0, lever[2], -lever[1]}, {-lever[2], 0, lever[0]}, {lever[1], -lever[0], 0}};
            A.noalias() += J.transpose() * M * J;
            b.noalias() += J.transpose() * (M * residual);
        }
        if (step < kDescentSteps)
            T = orthonormalized(frame.motion(solve_step(A, b, options.held, kMinEigenvalueToTrace * A.trace())) * T);
    }
    return {T, trimmed_mean(costs, options.overlap.value_or(1))};
}

// Super-Fibonacci spirals (Alexa, CVPR 2022): n evenly distributed rotations, for any n.
std::vector<Eigen::Matrix3d> super_fibonacci_rotations(int n)
{
    constexpr double kPsi = 1.533751168755204288118041; // root of x⁴ = x + 4
    std::vector<Eigen::Matrix3d> rotations;
    for (int i = 0; i < n; ++i) {
        const double s = i + 0.5, r = std::sqrt(s / n), R = std::sqrt(1 - s / n);
        const double alpha = 2 * std::numbers::pi * s / std::numbers::sqrt2, beta = 2 * std::numbers::pi * s / kPsi;
        rotations.push_back(
            Eigen::Quaterniond(R * std::cos(beta), r * std::sin(alpha), r * std::cos(alpha), R * std::sin(beta))
                .toRotationMatrix());
    }
    return rotations;
}

// The 24 rotations that map coordinate axes to coordinate axes (those of a cube).
std::vector<Eigen::Matrix3d> cube_rotations()
{
    std::vector<Eigen::Matrix3d> rotations;
    for (int x = 0; x < 3; ++x)
        for (int y = 0; y < 3; ++y)
            for (const int signs : {0, 1, 2, 3}) {
                if (x == y) continue;
                const Eigen::Vector3d X = Eigen::Vector3d::Unit(x) * (signs & 1 ? -1 : 1);
                const Eigen::Vector3d Y = Eigen::Vector3d::Unit(y) * (signs & 2 ? -1 : 1);
                rotations.emplace_back() << X, Y, X.cross(Y);
            }
    return rotations;
}

Eigen::Matrix3d principal_axes(const Eigen::Matrix3Xd& points)
{
    const Eigen::Matrix3Xd centred = points.colwise() - Eigen::Vector3d(points.rowwise().mean());
    const core::SymmetricEigen<3> scatter = core::symmetric_eigen<3>(centred * centred.transpose());
    Eigen::Matrix3d axes = scatter.vectors;
    axes.col(2) = axes.col(0).cross(axes.col(1));
    return axes;
}

// Rotations to start from, at each of `positions` start positions.
std::vector<Eigen::Matrix3d> start_rotations(const Eigen::Matrix3Xd& scan, const Eigen::Matrix3Xd& reference,
                                             const HeldAxes& held, int positions)
{
    const int free = !held[3] + !held[4] + !held[5];
    std::vector<Eigen::Matrix3d> rotations;
    if (free == 3) {
        const int count = std::clamp(kMaxDescents / positions, kMinRotations, kMaxRotations);
        const Eigen::Matrix3d from = principal_axes(scan).transpose(), to = principal_axes(reference);
        rotations = cube_rotations();
        for (const Eigen::Matrix3d& rotation : super_fibonacci_rotations(count)) rotations.push_back(rotation);
        for (Eigen::Matrix3d& rotation : rotations) rotation = to * rotation * from;
        return rotations;
    }
    if (free != 1) return {Eigen::Matrix3d::Identity()};
    const Eigen::Vector3d axis = Eigen::Vector3d::Unit(!held[3] ? 0 : !held[4] ? 1 : 2);
    for (int i = 0; i < kRotationsAboutAxis; ++i)
        rotations.push_back(Eigen::AngleAxisd(2 * std::numbers::pi * i / kRotationsAboutAxis, axis).toRotationMatrix());
    return rotations;
}

// Start positions of the scan's centroid: the reference's centroid, and if the scan is smaller, points all over the
// reference.
Eigen::Matrix3Xd start_positions(const Eigen::Matrix3Xd& reference, const Eigen::Vector3d& centroid, double scan_radius)
{
    // A descent converges over about half a scan radius: some thirty positions suffice for a scan half as large as the
    // reference.
    const double ratio = twist_frame(reference).radius / scan_radius;
    constexpr double kMaxCentredSizeRatio = 1.25, kMaxPositions = 30;
    const Eigen::Index count = ratio <= kMaxCentredSizeRatio ? 0 : std::min(kMaxPositions, 6 * ratio * ratio);
    const std::vector<Eigen::Index> chosen = farthest_point_sample(reference, count);
    Eigen::Matrix3Xd positions(3, 1 + chosen.size());
    positions << centroid, reference(Eigen::all, chosen);
    return positions;
}

// Poses to start descents from.
std::vector<Eigen::Isometry3d> start_poses(const Eigen::Matrix3Xd& scan, const Eigen::Matrix3Xd& reference,
                                           const TwistFrame& frame, const HeldAxes& held)
{
    // Centroids and principal axes are taken from samples of equal size and even spread, so that the point density of
    // scan and reference has no influence. A farthest point sample begins with the samples of a smaller one.
    const Eigen::Matrix3Xd coarse_reference = reference.leftCols(std::min(kScanSamples, reference.cols()));
    const Eigen::Vector3d scan_centroid = scan.rowwise().mean();
    const Eigen::Matrix3Xd positions = start_positions(reference, coarse_reference.rowwise().mean(), frame.radius);
    std::vector<Eigen::Isometry3d> starts;
    for (const Eigen::Matrix3d& rotation : start_rotations(scan, coarse_reference, held, positions.cols()))
        for (const Eigen::Vector3d& position : positions.colwise()) {
            Eigen::Isometry3d start(rotation);
            start.translation() = position - rotation * scan_centroid;
            for (int k = 0; k < 3; ++k) // a held shift leaves the centre of the motion where it is
                if (held[k]) start.translation()[k] = (frame.centre - rotation * frame.centre)[k];
            starts.push_back(start);
        }
    return starts;
}

OrientedPoints selected(const OrientedPoints& points, const std::vector<Eigen::Index>& indices)
{
    return {points.xyz(Eigen::all, indices), points.normals(Eigen::all, indices), points.outward};
}

} // namespace

double pose_distance(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b, const TwistFrame& frame)
{
    const double angle = Eigen::AngleAxisd(a.linear() * b.linear().transpose()).angle();
    return (a * frame.centre - b * frame.centre).norm() + frame.radius * angle;
}

std::vector<PoseCandidate> search_poses(const OrientedPoints& all_scan, const TwistFrame& frame,
                                        const OrientedPoints& all_reference, const IcpOptions& options)
{
    const OrientedPoints reference_points =
        selected(all_reference, scattered_indices(all_reference.xyz.cols(), kMaxReferencePoints));
    const Eigen::Matrix3Xd scan = all_scan.xyz(Eigen::all, farthest_point_sample(all_scan.xyz, kScanSamples));
    const OrientedPoints reference =
        selected(reference_points, farthest_point_sample(reference_points.xyz, kReferenceSamples));
    const NearestPointGrid grid(reference, frame.radius / 2);
    const std::vector<Eigen::Isometry3d> starts = start_poses(scan, reference.xyz, frame, options.held);
    const bool is_free = std::ranges::find(options.held, true) == options.held.end();
    const std::vector<Eigen::Isometry3d> matches =
        is_free ? match_point_pairs(all_scan, reference_points) : std::vector<Eigen::Isometry3d>();
    const auto refined = [&](const std::vector<Eigen::Isometry3d>& poses, double width_radii) {
        std::vector<PoseCandidate> candidates(poses.size());
        tbb::parallel_for(std::size_t{0}, candidates.size(), [&](std::size_t i) {
            candidates[i] = refine_pose(poses[i], scan, frame, grid, options, width_radii * frame.radius);
        });
        return distinct_poses(std::move(candidates), &PoseCandidate::cost, frame, kDuplicateCandidateRadii, kMaxPoses);
    };
    std::vector<PoseCandidate> best = refined(starts, kInitialWidthRadii);
    // The two kinds are not compared by cost, which depends on the initial width of the kernel.
    for (const PoseCandidate& match : refined(matches, kMatchInitialWidthRadii)) best.push_back(match);
    return best;
}

} // namespace fettle::align
