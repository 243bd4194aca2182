#include "part/profile.h"

#include "core/constants.h"
#include "geometry/bounding_box.h"
#include "job/boundary.h"

#include <algorithm>
#include <cmath>

namespace fettle::part {
namespace {

using Eigen::Vector2d;

// Margin of a footprint, mm, so that points on its border are inside.
constexpr double kBoxMargin = 1e-9;

Eigen::AlignedBox2d box_around(const Eigen::Matrix2Xd& points, double margin)
{
    const Vector2d offset = Vector2d::Constant(margin + kBoxMargin);
    const Eigen::AlignedBox2d box = geometry::bounding_box(points);
    return {box.min() - offset, box.max() + offset};
}

double distance_to_segment(const Vector2d& p, const Vector2d& a, const Vector2d& b)
{
    const Vector2d ab = b - a;
    const double length2 = ab.squaredNorm();
    const double t = length2 > 0 ? std::clamp((p - a).dot(ab) / length2, 0.0, 1.0) : 0.0;
    return (p - a - t * ab).norm();
}

/// Distance to the outline, positive inside.
double signed_distance(const job::Polygon& outline, const Vector2d& p)
{
    const double distance = job::distance_to_edge(outline, p);
    return job::contains(outline, p) ? distance : -distance;
}

/// @param distance  from the centre line, mm
Anomaly ridge(const ScalarField2d& distance, const RidgeSection& section, const Eigen::AlignedBox2d& footprint)
{
    const double half = section.width / 2;
    const double h = section.height;
    Anomaly anomaly;
    anomaly.footprint = footprint;
    anomaly.creases.push_back([=](const Vector2d& p) { return half - distance(p); });
    if (section.round) {
        // Arc over the chord 2·half with the sagitta h.
        const double radius = (half * half + h * h) / (2 * h);
        anomaly.height = [=](const Vector2d& p) {
            const double r = distance(p);
            return r < half ? std::max(0.0, std::sqrt(radius * radius - r * r) - (radius - h)) : 0.0;
        };
    } else {
        const double lean = std::tan(section.draft);
        anomaly.height = [=](const Vector2d& p) { return std::clamp((half - distance(p)) / lean, 0.0, h); };
        anomaly.creases.push_back([=](const Vector2d& p) { return half - h * lean - distance(p); });
    }
    return anomaly;
}

/// Uniform in [-1, 1] for each lattice point: the finaliser of SplitMix64 (Steele, Lea, Flood 2014).
double lattice_value(std::uint64_t seed, std::int64_t i, std::int64_t j)
{
    std::uint64_t x = seed;
    for (const std::int64_t k : {i, j}) {
        x += 0x9e3779b97f4a7c15u + static_cast<std::uint64_t>(k);
        x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
        x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
        x ^= x >> 31;
    }
    return static_cast<double>(x >> 11) * 0x1p-52 - 1;
}

/// Value noise: lattice values blended by a quintic, so that slope and curvature are continuous.
double smooth_noise(std::uint64_t seed, const Vector2d& at)
{
    const Vector2d corner = at.array().floor();
    const Vector2d t = at - corner;
    const Eigen::Array2d fade = t.array().cube() * (t.array() * (t.array() * 6 - 15) + 10);
    const auto i = static_cast<std::int64_t>(corner.x());
    const auto j = static_cast<std::int64_t>(corner.y());
    const double low = std::lerp(lattice_value(seed, i, j), lattice_value(seed, i + 1, j), fade.x());
    const double high = std::lerp(lattice_value(seed, i, j + 1), lattice_value(seed, i + 1, j + 1), fade.x());
    return std::lerp(low, high, fade.y());
}

} // namespace

Anomaly ridge_along(const Eigen::Matrix2Xd& path, const RidgeSection& section)
{
    const ScalarField2d distance = [path](const Vector2d& p) {
        double min = core::kInfinity;
        for (Eigen::Index i = 1; i < path.cols(); ++i)
            min = std::min(min, distance_to_segment(p, path.col(i - 1), path.col(i)));
        return min;
    };
    return ridge(distance, section, box_around(path, section.width / 2));
}

Anomaly ring(const Vector2d& centre, double radius, const RidgeSection& section)
{
    const ScalarField2d distance = [=](const Vector2d& p) { return std::abs((p - centre).norm() - radius); };
    return ridge(distance, section, box_around(centre, radius + section.width / 2));
}

Anomaly dot(const Vector2d& centre, double radius, double height)
{
    const ScalarField2d distance = [=](const Vector2d& p) { return (p - centre).norm(); };
    return ridge(distance, {.width = 2 * radius, .height = height}, box_around(centre, radius));
}

Anomaly stub(const Eigen::Matrix2Xd& outline, const SlopedTop& top, double draft)
{
    const Vector2d along(std::cos(top.direction), std::sin(top.direction));
    const Eigen::RowVectorXd positions = along.transpose() * outline;
    const double first = positions.minCoeff();
    const double slope = (top.high - top.low) / (positions.maxCoeff() - first);
    const ScalarField2d top_height = [=](const Vector2d& p) { return top.low + slope * (along.dot(p) - first); };
    const double lean = std::tan(draft);

    Anomaly anomaly;
    anomaly.footprint = box_around(outline, 0);
    anomaly.height = [=](const Vector2d& p) {
        return std::max(0.0, std::min(signed_distance(outline, p) / lean, top_height(p)));
    };
    anomaly.creases.push_back([=](const Vector2d& p) { return signed_distance(outline, p); });
    anomaly.creases.push_back([=](const Vector2d& p) { return signed_distance(outline, p) - lean * top_height(p); });
    return anomaly;
}

Anomaly blob(const Eigen::Matrix2Xd& outline, double height, double falloff)
{
    Anomaly anomaly;
    anomaly.footprint = box_around(outline, 0);
    anomaly.height = [=](const Vector2d& p) {
        const double t = std::clamp(signed_distance(outline, p) / falloff, 0.0, 1.0);
        return height * t * t * (3 - 2 * t);
    };
    anomaly.creases.push_back([=](const Vector2d& p) { return signed_distance(outline, p); });
    return anomaly;
}

Anomaly hill(const Vector2d& centre, const Vector2d& semi_axes, double angle, double height)
{
    const Eigen::Matrix2d to_ellipse = Eigen::Rotation2Dd(-angle).toRotationMatrix();
    const ScalarField2d rho_squared = [=](const Vector2d& p) {
        return (to_ellipse * (p - centre)).cwiseQuotient(semi_axes).squaredNorm();
    };
    Anomaly anomaly;
    anomaly.footprint = box_around(centre, semi_axes.maxCoeff());
    anomaly.height = [=](const Vector2d& p) {
        const double t = std::max(0.0, 1 - rho_squared(p));
        return height * t * t;
    };
    anomaly.creases.push_back(
        [=](const Vector2d& p) { return semi_axes.minCoeff() * (1 - std::sqrt(rho_squared(p))); });
    return anomaly;
}

Anomaly roughened(const Anomaly& anomaly, const Roughness& roughness)
{
    Anomaly rough = anomaly;
    rough.height = [smooth = anomaly.height, roughness](const Vector2d& p) {
        const double h = smooth(p);
        return h > 0 ? h * (1 + roughness.size * smooth_noise(roughness.seed, p / roughness.grain)) : 0.0;
    };
    return rough;
}

double height(const std::vector<Anomaly>& anomalies, const Vector2d& xy)
{
    double highest = 0;
    for (const Anomaly& anomaly : anomalies)
        if (anomaly.footprint.contains(xy)) highest = std::max(highest, anomaly.height(xy));
    return highest;
}

} // namespace fettle::part
