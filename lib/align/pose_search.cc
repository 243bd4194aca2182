#include "align/pose_search.h"

#include "cloud/neighbours.h"
#include "core/decompositions.h"

#include <Eigen/Core>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace fettle {

namespace {

constexpr Eigen::Index kScanPoints = 160;       // of the scan that steps are taken with
constexpr Eigen::Index kReferencePoints = 4000; // of the reference
// Every rotation is within some 20° of one of 1000 turns, within 35° of one of 200; a descent reaches about 40°. From
// more places than one fewer turns are tried.
constexpr int kMostTurns = 1000, kFewestTurns = 200, kDescents = 6000;
constexpr int kTurnsAboutAxis = 36;
constexpr int kSteps = 24;
// Widths of the robust weight, in radii of the scan: from all that is near, down to the size of the map's cells.
constexpr double kWidest = 0.5, kNarrowest = 0.06;
// A foot pulls along its plane, too: fully in the first step, no more than this from two thirds of the steps on.
constexpr double kLeastAlong = 0.02, kLessAlong = 1.5;
// Of the trace of the normal equations: keeps still what no foot determines.
constexpr double kStill = 1e-6;
// Two poses closer than this, in radii, are one.
constexpr double kSame = 0.15;
constexpr std::size_t kMostPoses = 32;

/// The nearest point of the reference for each cell of a grid about it: quick to ask, and right to a cell.
class NearestMap {
  public:
    NearestMap(const OrientedPoints& reference, double margin) : points_(reference)
    {
        const Eigen::Matrix<double, 3, 2> box = bounding_box(reference.xyz);
        constexpr double kCells = 56; // along the longest side
        least_ = box.col(0).array() - margin;
        const Eigen::Array3d size = box.col(1) - box.col(0) + Eigen::Vector3d::Constant(2 * margin);
        cell_ = size.maxCoeff() / kCells;
        count_ = (size / cell_).ceil().cast<int>().max(1);
        nearest_.resize(static_cast<std::size_t>(count_.prod()));
        const Neighbours neighbours(reference.xyz);
        std::vector<double> apart(static_cast<std::size_t>(reference.xyz.cols()));
        tbb::parallel_for(tbb::blocked_range<Eigen::Index>(0, reference.xyz.cols()), [&](const auto& range) {
            for (Eigen::Index i = range.begin(); i < range.end(); ++i) {
                const Eigen::Vector3d p = reference.xyz.col(i);
                apart[static_cast<std::size_t>(i)] = (reference.xyz.col(neighbours.nearest(p, 2).back()) - p).norm();
            }
        });
        std::nth_element(apart.begin(), apart.begin() + static_cast<std::ptrdiff_t>(apart.size() / 2), apart.end());
        slack_ = apart[apart.size() / 2] + cell_;
        tbb::parallel_for(tbb::blocked_range<int>(0, count_[2]), [&](const auto& range) {
            for (int k = range.begin(); k < range.end(); ++k)
                for (int j = 0; j < count_[1]; ++j)
                    for (int i = 0; i < count_[0]; ++i) {
                        const Eigen::Array3d middle = least_ + (Eigen::Array3d(i, j, k) + 0.5) * cell_;
                        nearest_[place(i, j, k)] = static_cast<std::int32_t>(neighbours.nearest(middle, 1).front());
                    }
        });
    }

    Eigen::Index operator()(const Eigen::Vector3d& p) const
    {
        const Eigen::Array3d at = ((p.array() - least_) / cell_).max(0.0).min((count_ - 1).cast<double>());
        return nearest_[place(static_cast<int>(at[0]), static_cast<int>(at[1]), static_cast<int>(at[2]))];
    }

    Eigen::Vector3d normal(Eigen::Index i) const { return points_.normals.col(i); }
    /// From the i-th point's disc, which reaches as far as the map may be wrong along the surface, to `p`.
    Eigen::Vector3d offset(Eigen::Index i, const Eigen::Vector3d& p) const
    {
        const Eigen::Vector3d n = normal(i), whole = p - points_.xyz.col(i);
        const Eigen::Vector3d across = n.dot(whole) * n, along = whole - across;
        const double length = along.norm();
        if (n.isZero(0)) return whole;
        return length > slack_ ? Eigen::Vector3d(across + (1 - slack_ / length) * along) : across;
    }

  private:
    std::size_t place(int i, int j, int k) const
    {
        return (static_cast<std::size_t>(k) * static_cast<std::size_t>(count_[1]) + static_cast<std::size_t>(j)) *
                   static_cast<std::size_t>(count_[0]) +
               static_cast<std::size_t>(i);
    }

    const OrientedPoints& points_;
    Eigen::Array3d least_;
    double cell_ = 0, slack_ = 0; // mm
    Eigen::Array3i count_;
    std::vector<std::int32_t> nearest_;
};

// Geman and McClure's weight narrows from step to step (Zhou, Park & Koltun, Fast Global Registration, 2016). A foot
// pulls across its plane, and less and less along it: the first steps bring the scan near, the last ones let it slide.
Pose descend(Eigen::Isometry3d T, const Eigen::Matrix3Xd& scan, const TwistFrame& about, const NearestMap& map,
             const HeldAxes& held)
{
    const auto n = static_cast<double>(scan.cols());
    const double radius = about.radius;
    double cost = 1;
    for (int step = 0; step <= kSteps; ++step) {
        const double share = std::min(1.0, step / (kSteps - 4.0)); // the last steps stay at the narrowest
        const double width = radius * kWidest * std::pow(kNarrowest / kWidest, share);
        const double along = std::max(kLeastAlong, 1 - kLessAlong * share);
        const Eigen::Matrix3Xd at = T * scan;
        const TwistFrame frame{T * about.centre, radius};
        TwistMatrix A = TwistMatrix::Zero();
        Twist b = Twist::Zero();
        cost = 0;
        for (Eigen::Index i = 0; i < at.cols(); ++i) {
            const Eigen::Vector3d p = at.col(i);
            const Eigen::Index foot = map(p);
            const Eigen::Vector3d offset = map.offset(foot, p), normal = map.normal(foot);
            const double relative = offset.squaredNorm() / (width * width);
            cost += relative / (1 + relative) / n;
            const double weight = 1 / ((1 + relative) * (1 + relative));
            const Eigen::Matrix3d M =
                weight * (along * Eigen::Matrix3d::Identity() + (1 - along) * normal * normal.transpose());
            Eigen::Matrix<double, 3, 6> J;
            const Eigen::Vector3d arm = (p - frame.centre) / radius;
            J << Eigen::Matrix3d::Identity(), //
                Eigen::Matrix3d{{0, arm[2], -arm[1]}, {-arm[2], 0, arm[0]}, {arm[1], -arm[0], 0}};
            A.noalias() += J.transpose() * M * J;
            b.noalias() += J.transpose() * (M * offset);
        }
        if (step < kSteps) T = straightened(frame.motion(solve_step(A, b, held, kStill * A.trace())) * T);
    }
    return {T, cost};
}

// Super-Fibonacci spirals (Alexa, CVPR 2022): n rotations as even as can be, for any n.
std::vector<Eigen::Matrix3d> even_turns(int n)
{
    constexpr double kPsi = 1.533751168755204288118041; // root of x⁴ = x + 4
    std::vector<Eigen::Matrix3d> turns;
    for (int i = 0; i < n; ++i) {
        const double s = i + 0.5, r = std::sqrt(s / n), R = std::sqrt(1 - s / n);
        const double alpha = 2 * std::numbers::pi * s / std::numbers::sqrt2, beta = 2 * std::numbers::pi * s / kPsi;
        turns.push_back(
            Eigen::Quaterniond(R * std::cos(beta), r * std::sin(alpha), r * std::cos(alpha), R * std::sin(beta))
                .toRotationMatrix());
    }
    return turns;
}

// The 24 rotations that lay axes on axes.
std::vector<Eigen::Matrix3d> axis_turns()
{
    std::vector<Eigen::Matrix3d> turns;
    for (int x = 0; x < 3; ++x)
        for (int y = 0; y < 3; ++y)
            for (const int signs : {0, 1, 2, 3}) {
                if (x == y) continue;
                const Eigen::Vector3d X = Eigen::Vector3d::Unit(x) * (signs & 1 ? -1 : 1);
                const Eigen::Vector3d Y = Eigen::Vector3d::Unit(y) * (signs & 2 ? -1 : 1);
                Eigen::Matrix3d turn;
                turn << X, Y, X.cross(Y);
                turns.push_back(turn);
            }
    return turns;
}

Eigen::Matrix3d principal_axes(const Eigen::Matrix3Xd& points)
{
    const Eigen::Matrix3Xd about = points.colwise() - Eigen::Vector3d(points.rowwise().mean());
    const SymmetricEigen<3> spread = symmetric_eigen<3>(about * about.transpose());
    Eigen::Matrix3d axes = spread.vectors;
    axes.col(2) = axes.col(0).cross(axes.col(1));
    return axes;
}

std::vector<Eigen::Matrix3d> start_turns(const Eigen::Matrix3Xd& scan, const Eigen::Matrix3Xd& reference,
                                         const HeldAxes& held, Eigen::Index places)
{
    const int free = !held[3] + !held[4] + !held[5];
    if (free == 3) {
        const int count = std::clamp(kDescents / static_cast<int>(places), kFewestTurns, kMostTurns);
        const Eigen::Matrix3d from = principal_axes(scan).transpose(), to = principal_axes(reference);
        std::vector<Eigen::Matrix3d> turns = axis_turns();
        for (const Eigen::Matrix3d& turn : even_turns(count)) turns.push_back(turn);
        for (Eigen::Matrix3d& turn : turns) turn = to * turn * from;
        return turns;
    }
    if (free != 1) return {Eigen::Matrix3d::Identity()};
    const Eigen::Vector3d axis = Eigen::Vector3d::Unit(!held[3] ? 0 : !held[4] ? 1 : 2);
    std::vector<Eigen::Matrix3d> turns;
    for (int i = 0; i < kTurnsAboutAxis; ++i)
        turns.push_back(Eigen::AngleAxisd(2 * std::numbers::pi * i / kTurnsAboutAxis, axis).toRotationMatrix());
    return turns;
}

// Where the scan's middle may lie: on the reference's, and if the scan is smaller, all over the reference.
Eigen::Matrix3Xd start_places(const Eigen::Matrix3Xd& reference, const Eigen::Vector3d& middle, double scan_radius)
{
    // A descent finds its way over about half a radius: some thirty places do for a scan half as large.
    const double ratio = twist_frame(reference).radius / scan_radius;
    constexpr double kAsLarge = 1.25, kMostPlaces = 30;
    const auto count = ratio <= kAsLarge ? 0 : static_cast<Eigen::Index>(std::min(kMostPlaces, 6 * ratio * ratio));
    const std::vector<Eigen::Index> chosen = farthest_points(reference, count);
    Eigen::Matrix3Xd places(3, 1 + static_cast<Eigen::Index>(chosen.size()));
    places << middle, reference(Eigen::all, chosen);
    return places;
}

} // namespace

double distance_between(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b, const TwistFrame& about)
{
    const double angle = Eigen::AngleAxisd(a.linear() * b.linear().transpose()).angle();
    return (a * about.centre - b * about.centre).norm() + about.radius * angle;
}

std::vector<Pose> search_poses(const Eigen::Matrix3Xd& scan_points, const TwistFrame& about,
                               const OrientedPoints& reference_points, const HeldAxes& held)
{
    const Eigen::Vector3d& middle = about.centre;
    const double radius = about.radius;
    const Eigen::Matrix3Xd scan = scan_points(Eigen::all, farthest_points(scan_points, kScanPoints));
    const std::vector<Eigen::Index> spread = farthest_points(reference_points.xyz, kReferencePoints);
    const OrientedPoints reference{reference_points.xyz(Eigen::all, spread),
                                   reference_points.normals(Eigen::all, spread)};
    const NearestMap map(reference, radius / 2);
    // Where both lie, and their axes, by as many points spread in the same way: their density plays no part.
    const Eigen::Matrix3Xd outline = reference.xyz.leftCols(std::min(kScanPoints, reference.xyz.cols()));
    const Eigen::Vector3d scan_middle = scan.rowwise().mean();
    const Eigen::Matrix3Xd places = start_places(reference.xyz, outline.rowwise().mean(), radius);
    const std::vector<Eigen::Matrix3d> turns = start_turns(scan, outline, held, places.cols());

    std::vector<Pose> found(turns.size() * static_cast<std::size_t>(places.cols()));
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, found.size()), [&](const auto& range) {
        for (std::size_t i = range.begin(); i < range.end(); ++i) {
            Eigen::Isometry3d start(turns[i % turns.size()]);
            const Eigen::Vector3d place = places.col(static_cast<Eigen::Index>(i / turns.size()));
            start.translation() = place - start.linear() * scan_middle;
            for (int k = 0; k < 3; ++k)
                if (held[static_cast<std::size_t>(k)]) start.translation()[k] = (middle - start.linear() * middle)[k];
            found[i] = descend(start, scan, about, map, held);
        }
    });
    std::stable_sort(found.begin(), found.end(), [](const Pose& a, const Pose& b) { return a.cost < b.cost; });
    std::vector<Pose> distinct_poses;
    for (const Pose& pose : found) {
        const auto same = [&](const Pose& other) {
            return distance_between(pose.T_reference_scan, other.T_reference_scan, about) < kSame * radius;
        };
        if (std::none_of(distinct_poses.begin(), distinct_poses.end(), same)) distinct_poses.push_back(pose);
        if (distinct_poses.size() == kMostPoses) break;
    }
    return distinct_poses;
}

} // namespace fettle
