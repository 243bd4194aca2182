#include "merge/joint_fit.h"

#include "core/decompositions.h"
#include "geometry/quantiles.h"
#include "geometry/sum.h"

#include <Eigen/Cholesky>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>

namespace fettle::merge {
namespace {

// A plane's three coefficients and so many points more, by which the noise is known within a third.
constexpr int kMinHeightPoints = 9;
// A scan whose points lie to one side of the place, by this share of the radius, ends there: its plane is tilted by
// what it does not see.
constexpr double kMaxEccentricity = 0.2;
// Normals of a scan and of the place: other faces of the part are not meant.
constexpr double kMinPlaneCosine = 0.7;
// The scan's noise counts as so many points more than those of a plane: some lie in a plane by chance, and would weigh
// most. With a mean of 22 degrees of freedom the inverse of the own variance is 10 % too large in the mean, and a sum
// with such weights scatters by 22 % more than they say.
constexpr double kNoisePoints = 20;

/// A scan's surface at a place.
struct Height {
    std::size_t scan;
    double height;         ///< over the place along its normal, mm
    double weight;         ///< 1/variance, 1/mm²
    Eigen::Vector3d slope; ///< by which a small motion changes the height: the place's normal, tilted as the plane is
};

/// Height of a scan over a place, by the plane z = c₀ + c₁ u + c₂ v through its points within `radius`; nothing if the
/// scan ends there or sees another face.
/// @param fitted  becomes those points
std::optional<Height> height_of(const Scan& scan, const Place& at, const SurfacePlace& at_surface, double radius,
                                std::vector<std::uint32_t>& fitted)
{
    fitted.clear();
    const Eigen::Isometry3d to_scan = at.T_world_scan.inverse();
    const Eigen::Vector3d p = to_scan * at_surface.place, n = to_scan.linear() * at_surface.normal;
    const Eigen::Vector3d along = n.unitOrthogonal(), across = n.cross(along);
    Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
    Eigen::Vector3d b = Eigen::Vector3d::Zero();
    double squares = 0;
    for (const std::size_t v : scan.grid.around(p))
        for (const std::uint32_t i : scan.grid.points(v)) {
            const Eigen::Vector3d d = scan.xyz.col(i) - p;
            const double u = d.dot(along), w = d.dot(across), z = d.dot(n);
            if (u * u + w * w > radius * radius || std::abs(z) > radius) continue;
            const Eigen::Vector3d terms(1, u / radius, w / radius);
            A.noalias() += terms * terms.transpose();
            b += z * terms;
            squares += z * z;
            fitted.push_back(i);
        }
    const auto count = static_cast<double>(fitted.size());
    if (count < kMinHeightPoints) return std::nullopt;
    if (A.col(0).tail<2>().norm() > kMaxEccentricity * count) return std::nullopt;
    const Eigen::LDLT<Eigen::Matrix3d> ldlt(A);
    const Eigen::Vector3d c = ldlt.solve(b);
    const double slope = c.tail<2>().norm() / radius;
    if (1 / std::sqrt(1 + slope * slope) < kMinPlaneCosine) return std::nullopt;
    const double scans_noise = scan.means.noise * scan.means.noise;
    const double residuals = std::max(0.0, squares - c.dot(b));
    const double noise = (residuals + kNoisePoints * scans_noise) / (count - 3 + kNoisePoints);
    const double share = ldlt.solve(Eigen::Vector3d::UnitX())[0];
    constexpr double kRounding = 1e-6; // of coordinates in files, relative to the radius
    // Scatter beyond the noise is a bend, whose height depends on where the points happen to lie.
    constexpr double kMinBendRatio = 1.5, kBendShare = 0.5;
    const double bend = std::max(0.0, residuals / (count - 3) - kMinBendRatio * scans_noise);
    const double variance = share * noise + kBendShare * kBendShare * bend + std::pow(kRounding * radius, 2);
    const Eigen::Vector3d tilted = n - (c[1] * along + c[2] * across) / radius;
    return Height{0, c[0], 1 / variance, at.T_world_scan.linear() * tilted};
}

/// Sums over the differences of a pair.
struct PairSums {
    align::TwistMatrix information = align::TwistMatrix::Zero();
    align::Twist rhs = align::Twist::Zero();
    double squares = 0, count = 0;
};

/// Their pose of least squares. Motions that the differences do not determine stay as they are, with no information.
PoseEdge edge_of(const IndexPair& pair, const PairPose& pose, const align::TwistFrame& frame, const PairSums& sums)
{
    PoseEdge edge{pair.a, pair.b, pose.T_b_a, frame, align::TwistMatrix::Zero()};
    // Errors of the normals seem to determine motions that the surface leaves free, as in align::icp().
    constexpr double kMinSlope = 0.01;
    const double min_information = kMinSlope * kMinSlope * sums.information.topLeftCorner<3, 3>().trace();
    const auto [values, vectors] = core::symmetric_eigen<6>(sums.information);
    align::Twist x = align::Twist::Zero();
    for (int k = 0; k < 6; ++k) {
        if (!(values[k] > min_information)) continue;
        edge.information += values[k] * vectors.col(k) * vectors.col(k).transpose();
        x -= vectors.col(k).dot(sums.rhs) / values[k] * vectors.col(k);
    }
    edge.T_b_a = align::orthonormalized(frame.motion(x) * pose.T_b_a);
    return edge;
}

/// What the scans are at each place.
struct Heights {
    std::vector<std::vector<Height>> at; ///< of each place, those of the scans that see it
    /// Neighbouring planes share points: a sum over places has so many times the variance of one over as many planes
    /// without common points, Σ n² / Σ n where a point is in n planes.
    double repetition = 1;
};

Heights heights_at(const std::vector<SurfacePlace>& surface, const Scans& scans,
                   const std::vector<std::optional<Place>>& places, double length)
{
    Heights heights{std::vector<std::vector<Height>>(surface.size())};
    std::vector<std::vector<std::atomic<std::uint32_t>>> uses; // of the points of each scan
    for (const auto& scan : scans) uses.emplace_back(static_cast<std::size_t>(scan->xyz.cols()));
    tbb::parallel_for(std::size_t{0}, surface.size(), [&](std::size_t k) {
        if (surface[k].normal.isZero(0)) return;
        std::vector<std::uint32_t> fitted;
        for (std::size_t s = 0; s < scans.size(); ++s) {
            if (!places[s]) continue;
            auto height = height_of(*scans[s], *places[s], surface[k], length, fitted);
            if (!height) continue;
            height->scan = s;
            heights.at[k].push_back(*height);
            for (const std::uint32_t i : fitted) uses[s][i].fetch_add(1, std::memory_order_relaxed);
        }
    });
    double once = 0, squares = 0;
    for (const auto& of_scan : uses)
        for (const std::uint32_t n : of_scan) {
            once += n;
            squares += static_cast<double>(n) * n;
        }
    if (once > 0) heights.repetition = squares / once;
    return heights;
}

} // namespace

std::vector<SurfacePlace> surface_places(const Scans& scans, const std::vector<std::optional<Place>>& places,
                                         double length)
{
    Eigen::Index total = 0;
    for (std::size_t s = 0; s < scans.size(); ++s)
        if (places[s]) total += scans[s]->means.xyz.cols();
    Eigen::Matrix3Xd xyz(3, total), normals(3, total);
    Eigen::Index next = 0;
    for (std::size_t s = 0; s < scans.size(); ++s) {
        if (!places[s]) continue;
        const VoxelMeans& means = scans[s]->means;
        xyz.middleCols(next, means.xyz.cols()) = places[s]->T_world_scan * means.xyz;
        normals.middleCols(next, means.xyz.cols()) =
            places[s]->side * (places[s]->T_world_scan.linear() * means.normals);
        next += means.xyz.cols();
    }
    const VoxelGrid grid(xyz, length);
    std::vector<SurfacePlace> found;
    for (std::size_t v = 0; v < grid.size(); ++v) {
        const Eigen::Index first = grid.points(v).front(); // the other side of a thin wall has another normal
        Eigen::Vector3d sum = Eigen::Vector3d::Zero(), normal = Eigen::Vector3d::Zero();
        double count = 0;
        for (const std::uint32_t i : grid.points(v)) {
            if (!(normals.col(i).dot(normals.col(first)) > 0)) continue;
            sum += xyz.col(i);
            normal += normals.col(i);
            ++count;
        }
        if (count > 0) found.push_back({sum / count, normal.stableNormalized()});
    }
    return found;
}

JointFit fit_jointly(const Scans& scans, const std::vector<std::optional<Place>>& places,
                     const std::vector<IndexPair>& pairs, const std::vector<SurfacePlace>& surface, double length)
{
    const Heights all = heights_at(surface, scans, places, length);
    std::map<std::pair<std::size_t, std::size_t>, std::size_t> number;
    std::vector<align::TwistFrame> frames; // in b's frame
    std::vector<Eigen::Isometry3d> to_b;
    for (const auto& [a, b] : pairs) {
        number[{a, b}] = to_b.size();
        to_b.push_back(places[b]->T_world_scan.inverse());
        frames.push_back({to_b.back() * (places[a]->T_world_scan * scans[a]->frame.centre), scans[a]->frame.radius});
    }
    std::vector<PairSums> sums(pairs.size());
    std::vector<double> seen(scans.size(), 0);
    geometry::CompensatedSum weighted_squares, freedom;
    for (std::size_t n = 0; n < surface.size(); ++n) {
        const std::vector<Height>& heights = all.at[n];
        double weights = 0;
        for (const Height& h : heights) {
            ++seen[h.scan];
            weights += h.weight;
        }
        const auto seeing = static_cast<double>(heights.size());
        for (const Height& a : heights)
            for (const Height& b : heights) {
                const auto found = number.find({a.scan, b.scan});
                if (found == number.end()) continue;
                const double offset = a.height - b.height;
                const double relative = offset / (geometry::kTukeyCutoff * std::sqrt(1 / a.weight + 1 / b.weight));
                PairSums& sum = sums[found->second];
                if (std::abs(relative) >= 1) continue;
                const double robust = std::pow(1 - relative * relative, 2), weight = a.weight * b.weight / weights;
                const align::Twist g = frames[found->second].gradient(
                    to_b[found->second] * surface[n].place, to_b[found->second].linear() * (a.slope + b.slope) / 2);
                sum.information.noalias() += robust * weight * g * g.transpose();
                sum.rhs += robust * weight * offset * g;
                sum.squares += offset * offset;
                ++sum.count;
                weighted_squares.add(robust * weight * offset * offset);
                freedom.add(robust * 2 / seeing); // m scans: m - 1 degrees of freedom in m (m - 1) / 2 differences
            }
    }
    JointFit fit;
    for (std::size_t k = 0; k < pairs.size(); ++k) {
        const auto [a, b] = pairs[k];
        const PairSums& sum = sums[k];
        fit.pairs.push_back({edge_of(pairs[k], pose_between(*places[a], *places[b]), frames[k], sum),
                             sum.count / std::max(1.0, seen[a]), sum.count / std::max(1.0, seen[b]),
                             std::sqrt(sum.squares / std::max(1.0, sum.count))});
    }
    const double scale = freedom.value() > 0 ? weighted_squares.value() / freedom.value() : 1;
    fit.scatter = std::sqrt(scale);
    fit.variance_scale = all.repetition * std::max(1.0, scale);
    return fit;
}

} // namespace fettle::merge
