#include "align/point_pairs.h"

#include "align/pose_search.h"
#include "align/rigid.h"
#include "geometry/point_index.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <span>

namespace fettle::align {

namespace {

// Points of the smaller cloud, whose pairs are tabulated: some twenty along it.
constexpr Eigen::Index kModelPoints = 500; // fewer than 2^16, which number them
// Points of the larger one: as dense, up to so many, which bounds the time.
constexpr Eigen::Index kMinScenePoints = 1000, kMaxScenePoints = 4000;
constexpr double kSceneDensity =
    2; // relative to the model's: only one of two points then falls far from a model's point
// Bins of a pair's distance, of its angles (12°), and of the turn about a normal (12°), as in the paper.
constexpr int kDistanceBins = 20, kAngleBins = 15, kTurnBins = 30;
// A pair that fits more pairs of the model than this says too little about the pose to be worth the time: two points of
// a plane.
constexpr std::size_t kMaxEqualPairs = 2000;
// Poses nearer than this, in radii of the model, add their votes; twice the width of the turns' bins.
constexpr double kClusterRadii = 0.4;
constexpr std::size_t kMaxVotedPoses = 2000, kMaxMatches = 32; // that are clustered; that are returned

struct Pose {
    Eigen::Isometry3d T_scene_model;
    double votes = 0;
};

/// A motion that takes a point to the origin and its normal to +x.
Eigen::Isometry3d to_origin(const Eigen::Vector3d& point, const Eigen::Vector3d& normal)
{
    Eigen::Isometry3d motion;
    const Eigen::Vector3d across = normal.unitOrthogonal();
    motion.linear() << normal.transpose(), across.transpose(), normal.cross(across).transpose();
    motion.translation() = -(motion.linear() * point);
    motion.makeAffine();
    return motion;
}

/// Turns in 1/65536 of a full one: sums and differences wrap by themselves.
using Turn = std::uint16_t;
constexpr int kTurnBits = 16;

/// Turn about x, from y, of a point in that frame.
Turn turn_about_x(const Eigen::Vector3d& point)
{
    const double turns = std::atan2(point.z(), point.y()) / (2 * std::numbers::pi);
    return static_cast<Turn>(static_cast<std::int32_t>(std::floor(turns * (1 << kTurnBits))));
}

/// The bin of an angle by its cosine, from a table of cosines: an arc cosine takes ten times as long.
int angle_bin(double cosine)
{
    struct Cell {
        double bound; ///< the cosine in this cell at which the next bin begins; -2: none
        int bin;      ///< of the largest cosines in it
    };
    constexpr int kCells = 256; // at most one bound falls into one: the narrowest bins are .022 wide
    static const auto cells = [] {
        std::array<Cell, kCells> table{};
        for (int c = 0; c < kCells; ++c) {
            const double low = 2.0 * c / kCells - 1, high = 2.0 * (c + 1) / kCells - 1;
            table[std::size_t(c)] = {-2, 0};
            for (int k = 1; k < kAngleBins; ++k) {
                const double bound = std::cos(k * std::numbers::pi / kAngleBins);
                if (bound >= high)
                    table[std::size_t(c)].bin = k;
                else if (bound >= low)
                    table[std::size_t(c)].bound = bound;
            }
        }
        return table;
    }();
    const int c = std::clamp(static_cast<int>((cosine + 1) * (kCells / 2)), 0, kCells - 1);
    return cells[std::size_t(c)].bin + (cosine <= cells[std::size_t(c)].bound);
}

/// Pairs of points with equal features, by the bin of their features.
class PairTable {
  public:
    struct Entry {
        std::uint16_t point; ///< first of the pair
        Turn turn;           ///< turn_about_x() of the second in the first's frame
    };

    explicit PairTable(const OrientedPoints& model)
    {
        const Eigen::Index n = model.xyz.cols();
        for (const Eigen::Vector3d& p : model.xyz.colwise())
            reach_ = std::max(reach_, (model.xyz.colwise() - p).colwise().norm().maxCoeff());
        reach_ *= 1 + 1e-9; // the longest pair falls into the last bin
        std::vector<std::uint32_t> bins(n * n);
        first_.assign(kDistanceBins * kAngleBins * kAngleBins * kAngleBins + 1, 0);
        for (Eigen::Index i = 0; i < n; ++i)
            for (Eigen::Index j = 0; j < n; ++j)
                if (i != j) ++first_[1 + (bins[i * n + j] = bin(model, i, model, j))];
        for (std::size_t b = 1; b < first_.size(); ++b) first_[b] += first_[b - 1];
        entries_.resize(first_.back());
        std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
        std::vector<Eigen::Isometry3d> frames;
        for (Eigen::Index i = 0; i < n; ++i) frames.push_back(to_origin(model.xyz.col(i), model.normals.col(i)));
        // In a bin other first points follow each other: their votes do not wait for the sum before them.
        for (Eigen::Index j = 0; j < n; ++j)
            for (Eigen::Index i = 0; i < n; ++i)
                if (i != j)
                    entries_[next[bins[i * n + j]]++] = {static_cast<std::uint16_t>(i),
                                                         turn_about_x(frames[std::size_t(i)] * model.xyz.col(j))};
    }

    /// Largest distance between two points, mm.
    double reach() const { return reach_; }

    /// Pairs of the model equal to one of `points`, no farther apart than reach().
    std::span<const Entry> equal_pairs(const OrientedPoints& points, Eigen::Index i, Eigen::Index j) const
    {
        const std::uint32_t b = bin(points, i, points, j);
        return {entries_.data() + first_[b], entries_.data() + first_[b + 1]};
    }

  private:
    std::uint32_t bin(const OrientedPoints& a, Eigen::Index i, const OrientedPoints& b, Eigen::Index j) const
    {
        const Eigen::Vector3d between = b.xyz.col(j) - a.xyz.col(i);
        const double length = between.norm(), scale = length > 0 ? 1 / length : 0;
        const int distance = std::min(kDistanceBins - 1, static_cast<int>(length / reach_ * kDistanceBins));
        const int first = angle_bin(scale * between.dot(a.normals.col(i)));
        const int second = angle_bin(scale * between.dot(b.normals.col(j)));
        const int both = angle_bin(a.normals.col(i).dot(b.normals.col(j)));
        return ((distance * kAngleBins + first) * kAngleBins + second) * kAngleBins + both;
    }

    double reach_ = 0;
    std::vector<std::uint32_t> first_; ///< bin -> its first entry
    std::vector<Entry> entries_;
};

/// The pose in which the pairs of a scene's point with its neighbours fit the model best.
Pose best_pose(const PairTable& table, const OrientedPoints& model, const OrientedPoints& scene, Eigen::Index point,
               const std::vector<Eigen::Index>& neighbours)
{
    const Eigen::Isometry3d frame = to_origin(scene.xyz.col(point), scene.normals.col(point));
    // Single precision, so that the votes stay near the processor: this loop is most of the search's time.
    using Votes = Eigen::Array<float, kTurnBins, Eigen::Dynamic>;
    Votes votes = Votes::Zero(kTurnBins, model.xyz.cols());
    for (const Eigen::Index other : neighbours) {
        if (other == point) continue;
        const std::span<const PairTable::Entry> pairs = table.equal_pairs(scene, point, other);
        if (pairs.empty() || pairs.size() > kMaxEqualPairs) continue;
        const Turn turn = turn_about_x(frame * scene.xyz.col(other));
        // They share one vote: what is frequent in the model says little.
        const float vote = 1.F / static_cast<float>(pairs.size());
        for (const PairTable::Entry& pair : pairs)
            votes(static_cast<Turn>(turn - pair.turn) * kTurnBins >> kTurnBits, pair.point) += vote;
    }
    Eigen::Index best = 0, best_bin = 0;
    float max_sum = -1;
    for (Eigen::Index m = 0; m < votes.cols(); ++m) {
        Eigen::Array<float, kTurnBins + 2, 1> around; // a full turn, and the bin before and after it
        around << votes(kTurnBins - 1, m), votes.col(m), votes(0, m);
        // With its neighbours: a turn may lie between two bins.
        const Eigen::Array<float, kTurnBins, 1> sums =
            votes.col(m) + (around.tail<kTurnBins>() + around.head<kTurnBins>()) / 2;
        if (sums.maxCoeff() <= max_sum) continue;
        max_sum = sums.maxCoeff(&best_bin);
        best = m;
    }
    const double turn = 2 * std::numbers::pi * (best_bin + 0.5) / kTurnBins;
    const Eigen::Isometry3d to_model = to_origin(model.xyz.col(best), model.normals.col(best));
    return {frame.inverse() * Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitX()) * to_model, max_sum};
}

/// Adds the votes of poses near each other. @return  the best of each cluster, most votes first
std::vector<Eigen::Isometry3d> clustered(std::vector<Pose> poses, const TwistFrame& frame)
{
    const auto more_votes = [](const Pose& a, const Pose& b) { return a.votes > b.votes; };
    std::stable_sort(poses.begin(), poses.end(), more_votes);
    poses.resize(std::min(poses.size(), kMaxVotedPoses));
    std::vector<Pose> clusters;
    const double limit = kClusterRadii * frame.radius;
    for (const Pose& pose : poses) {
        const Eigen::Vector3d centre = pose.T_scene_model * frame.centre;
        const auto near = [&](const Pose& other) {
            return (other.T_scene_model * frame.centre - centre).squaredNorm() < limit * limit &&
                   pose_distance(pose.T_scene_model, other.T_scene_model, frame) < limit;
        };
        const auto found = std::ranges::find_if(clusters, near);
        if (found == clusters.end())
            clusters.push_back(pose);
        else
            found->votes += pose.votes;
    }
    std::stable_sort(clusters.begin(), clusters.end(), more_votes);
    std::vector<Eigen::Isometry3d> best;
    for (const Pose& cluster : clusters)
        if (best.size() < kMaxMatches) best.push_back(cluster.T_scene_model);
    return best;
}

/// Evenly distributed points with the mean normals around them; points without a direction are left out.
OrientedPoints thinned(const OrientedPoints& points, Eigen::Index count)
{
    const std::vector<Eigen::Index> chosen = farthest_point_sample(points.xyz, count);
    const geometry::PointIndex<3> all(points.xyz), few(points.xyz(Eigen::all, chosen));
    OrientedPoints thin{Eigen::Matrix3Xd(3, chosen.size()), Eigen::Matrix3Xd(3, chosen.size()), points.outward};
    tbb::parallel_for(std::size_t{0}, chosen.size(), [&](std::size_t k) {
        const Eigen::Vector3d point = points.xyz.col(chosen[k]), own = points.normals.col(chosen[k]);
        const std::vector<Eigen::Index> nearest = few.nearest(point, 2);
        const double spacing = (points.xyz.col(chosen[nearest.back()]) - point).norm();
        Eigen::Vector3d sum = Eigen::Vector3d::Zero();
        for (const Eigen::Index i : all.radius_search(point, spacing / 2)) // a thin wall's other side does not count
            if (points.normals.col(i).dot(own) > 0) sum += points.normals.col(i);
        thin.xyz.col(k) = point;
        thin.normals.col(k) = sum.stableNormalized();
    });
    std::vector<Eigen::Index> directed;
    for (Eigen::Index k = 0; k < thin.xyz.cols(); ++k)
        if (!thin.normals.col(k).isZero(0)) directed.push_back(k);
    thin.xyz = thin.xyz(Eigen::all, directed).eval();
    thin.normals = thin.normals(Eigen::all, directed).eval();
    return thin;
}

/// The points no farther than `reach` from a point, which are most of them: a tree would take longer.
std::vector<Eigen::Index> points_within(const Eigen::Matrix3Xd& xyz, const Eigen::Vector3d& point, double reach)
{
    std::vector<Eigen::Index> within;
    within.reserve(static_cast<std::size_t>(xyz.cols()));
    for (Eigen::Index i = 0; i < xyz.cols(); ++i)
        if ((xyz.col(i) - point).squaredNorm() <= reach * reach) within.push_back(i);
    return within;
}

std::vector<Eigen::Isometry3d> match(const OrientedPoints& model, const OrientedPoints& scene)
{
    const PairTable table(model);
    // Without known outer sides the normals of a scan may all point the other way.
    const bool has_two_sides = !(model.outward && scene.outward);
    const OrientedPoints turned{scene.xyz, -scene.normals, scene.outward};
    const Eigen::Index count = scene.xyz.cols();
    std::vector<Pose> poses(static_cast<std::size_t>((has_two_sides ? 2 : 1) * count));
    tbb::parallel_for(Eigen::Index{0}, count, [&](Eigen::Index i) {
        const std::vector<Eigen::Index> neighbours = points_within(scene.xyz, scene.xyz.col(i), table.reach());
        poses[i] = best_pose(table, model, scene, i, neighbours);
        if (has_two_sides) poses[count + i] = best_pose(table, model, turned, i, neighbours);
    });
    return clustered(std::move(poses), twist_frame(model.xyz));
}

} // namespace

std::vector<Eigen::Isometry3d> match_point_pairs(const OrientedPoints& scan, const OrientedPoints& reference)
{
    const double ratio = twist_frame(reference.xyz).radius / twist_frame(scan.xyz).radius;
    const bool scan_is_model = ratio >= 1;
    const double area_ratio = std::pow(scan_is_model ? ratio : 1 / ratio, 2);
    const auto count = static_cast<Eigen::Index>(
        std::clamp<double>(kSceneDensity * kModelPoints * std::min<double>(area_ratio, kMaxScenePoints),
                           kMinScenePoints, kMaxScenePoints));
    const OrientedPoints model = thinned(scan_is_model ? scan : reference, kModelPoints);
    const OrientedPoints scene = thinned(scan_is_model ? reference : scan, count);
    if (model.xyz.cols() < 3 || scene.xyz.cols() < 3) return {};
    std::vector<Eigen::Isometry3d> poses = match(model, scene);
    if (!scan_is_model)
        for (Eigen::Isometry3d& pose : poses) pose = pose.inverse();
    return poses;
}

} // namespace fettle::align
