#include "surface/patches.h"

#include "surface/basis.h"
#include "units/units.h"
#include "json/document.h"
#include "json/units.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>

namespace fettle {

namespace {

constexpr int kHighestDegree = 7;
// Newton's method doubles the right digits in each step; a patch that needs more is folded.
constexpr int kMostNewtonSteps = 50;
// When the steps in u and v are at rounding, and how far outside the domain rounding may put them; relative to the
// domain.
constexpr double kRounding = 1e-12;
// Chords of a span of a trimming curve: a quarter of a circle bends off its chords by (π/2/64)²/8 of the radius.
constexpr int kChords = 64;
// How far apart the ends of a closed curve may be, relative to the domain: what six digits in a file leave open.
constexpr double kClosed = 1e-5;

Eigen::VectorXd read_knots(json::Reader& reader, const std::string& key, int degree, Eigen::Index control)
{
    if (control <= degree)
        reader.refuse("control", "degree " + std::to_string(degree) + " needs " + std::to_string(degree + 1) +
                                     " control points or more, got " + std::to_string(control));
    const Eigen::VectorXd knots = reader.vector(key);
    if (knots.size() != control + degree + 1)
        reader.refuse(key, "expected " + std::to_string(control + degree + 1) + " knots for " +
                               std::to_string(control) + " control points of degree " + std::to_string(degree) +
                               ", got " + std::to_string(knots.size()));
    for (Eigen::Index i = 1; i < knots.size(); ++i)
        if (knots[i] < knots[i - 1]) reader.refuse(key + "[" + std::to_string(i) + "]", "is less than the one before");
    for (Eigen::Index i = degree + 1; i < knots.size() - 1; ++i)
        if (knots[i] == knots[i - degree])
            reader.refuse(key + "[" + std::to_string(i) + "]",
                          "is repeated more than " + std::to_string(degree) + " times");
    if (!(knots[degree] < knots[knots.size() - degree - 1])) reader.refuse(key, "has no length");
    return knots;
}

Eigen::Vector2d point(const TrimCurve& curve, double t)
{
    const Basis at = basis(curve.knots, curve.degree, t);
    Eigen::VectorXd weights = at.value;
    if (curve.weights.size() > 0) weights.array() *= curve.weights.segment(at.first, weights.size()).array();
    return curve.control.middleCols(at.first, weights.size()) * weights / weights.sum();
}

TrimCurve read_trim(json::Reader reader, const Patch& patch)
{
    TrimCurve curve;
    curve.degree = reader.integer("degree", 1, kHighestDegree);
    curve.control = reader.matrix("control", 2).transpose();
    curve.knots = read_knots(reader, "knots", curve.degree, curve.control.cols());
    if (!reader.is_null("weights")) {
        curve.weights = reader.vector("weights", static_cast<int>(curve.control.cols()));
        if (curve.weights.minCoeff() <= 0) reader.refuse("weights", "must be positive");
    }
    const Eigen::Matrix2d limits = domain(patch);
    const Eigen::Vector2d size = limits.col(1) - limits.col(0);
    for (Eigen::Index i = 0; i < curve.control.cols(); ++i) {
        const Eigen::Vector2d uv = curve.control.col(i);
        if (((limits.col(0) - uv).cwiseMax(uv - limits.col(1)).array() > kRounding * size.array()).any())
            reader.refuse("control[" + std::to_string(i) + "]", "lies outside the knots of u or v");
        curve.control.col(i) = uv.cwiseMax(limits.col(0)).cwiseMin(limits.col(1));
    }
    const Eigen::Index last = curve.knots.size() - curve.degree - 1;
    const Eigen::Vector2d gap = point(curve, curve.knots[last]) - point(curve, curve.knots[curve.degree]);
    if ((gap.cwiseQuotient(size).cwiseAbs().array() > kClosed).any())
        reader.refuse("control", "is not closed: it ends elsewhere than it begins");
    reader.done();
    return curve;
}

Patch read_patch(json::Reader reader, double mm)
{
    Patch patch;
    const Eigen::VectorXd degree = reader.vector("degree", 2);
    for (const double d : degree)
        if (d < 1 || d > kHighestDegree || d != std::floor(d))
            reader.refuse("degree", "must be whole numbers from 1 to " + std::to_string(kHighestDegree));
    patch.degree_u = static_cast<int>(degree[0]);
    patch.degree_v = static_cast<int>(degree[1]);
    const std::vector<Eigen::MatrixXd> control = reader.grid("control", 3);
    for (std::size_t k = 0; k < 3; ++k) patch.control[k] = control[k] * mm;
    patch.knots_u = read_knots(reader, "knots_u", patch.degree_u, control[0].rows());
    patch.knots_v = read_knots(reader, "knots_v", patch.degree_v, control[0].cols());
    if (!reader.is_null("weights")) {
        patch.weights = reader.matrix("weights", static_cast<int>(control[0].cols()));
        if (patch.weights.rows() != control[0].rows()) reader.refuse("weights", "one row for each row of control");
        if (patch.weights.minCoeff() <= 0) reader.refuse("weights", "must be positive");
    }
    if (!reader.is_null("trim"))
        for (json::Reader& curve : reader.objects("trim")) patch.trim.push_back(read_trim(std::move(curve), patch));
    reader.done();
    return patch;
}

std::vector<Patch> read_patches(json::Reader reader)
{
    reader.expect_kind("patches");
    const double mm = mm_per(json::read_length_unit(reader));
    std::vector<Patch> patches;
    for (const json::Reader& patch : reader.objects("patches")) patches.push_back(read_patch(patch, mm));
    if (patches.empty()) reader.refuse("patches", "there is none");
    reader.done();
    return patches;
}

} // namespace

std::vector<Patch> read_patches(const std::string& path) { return read_patches(json::Reader::open(path)); }

std::vector<Patch> parse_patches(std::string_view text, const std::string& source)
{
    return read_patches(json::Reader::parse(text, source));
}

Eigen::Matrix2d domain(const Patch& patch)
{
    const auto most = [](const Eigen::VectorXd& knots, int degree) { return knots[knots.size() - degree - 1]; };
    Eigen::Matrix2d result;
    result << patch.knots_u[patch.degree_u], most(patch.knots_u, patch.degree_u), patch.knots_v[patch.degree_v],
        most(patch.knots_v, patch.degree_v);
    return result;
}

std::vector<Eigen::Matrix2Xd> outlines(const Patch& patch)
{
    if (patch.trim.empty()) {
        const Eigen::Matrix2d limits = domain(patch);
        Eigen::Matrix2Xd sides(2, 5);
        sides.row(0) << limits(0, 0), limits(0, 1), limits(0, 1), limits(0, 0), limits(0, 0);
        sides.row(1) << limits(1, 0), limits(1, 0), limits(1, 1), limits(1, 1), limits(1, 0);
        return {sides};
    }
    std::vector<Eigen::Matrix2Xd> polygons;
    for (const TrimCurve& curve : patch.trim) {
        std::vector<Eigen::Vector2d> points;
        for (Eigen::Index k = curve.degree; k + curve.degree + 1 < curve.knots.size(); ++k) {
            const double from = curve.knots[k], to = curve.knots[k + 1];
            const int chords = curve.degree == 1 && curve.weights.size() == 0 ? 1 : kChords;
            for (int i = 0; i < chords && from < to; ++i)
                points.push_back(point(curve, from + (to - from) * i / chords));
        }
        Eigen::Matrix2Xd polygon(2, points.size() + 1);
        for (std::size_t i = 0; i <= points.size(); ++i)
            polygon.col(static_cast<Eigen::Index>(i)) = points[i % points.size()];
        polygons.push_back(std::move(polygon));
    }
    return polygons;
}

bool inside(const std::vector<Eigen::Matrix2Xd>& outlines, const Eigen::Vector2d& uv)
{
    bool odd = false;
    for (const Eigen::Matrix2Xd& polygon : outlines)
        for (Eigen::Index i = 1; i < polygon.cols(); ++i) {
            const Eigen::Vector2d a = polygon.col(i - 1), b = polygon.col(i);
            if ((a.y() > uv.y()) == (b.y() > uv.y())) continue;
            if (uv.x() < a.x() + (b.x() - a.x()) * (uv.y() - a.y()) / (b.y() - a.y())) odd = !odd;
        }
    return odd;
}

Eigen::Matrix3d point_and_tangents(const Patch& patch, const Eigen::Vector2d& uv)
{
    const Basis u = basis(patch.knots_u, patch.degree_u, uv.x());
    const Basis v = basis(patch.knots_v, patch.degree_v, uv.y());
    const auto part = [&](const Eigen::MatrixXd& net) {
        return net.block(u.first, v.first, u.value.size(), v.value.size());
    };
    // Column 0: the sum, 1 and 2: its derivatives.
    const auto sums = [&](const Eigen::MatrixXd& net) {
        return Eigen::RowVector3d(u.value.dot(net * v.value), u.derivative.dot(net * v.value),
                                  u.value.dot(net * v.derivative));
    };
    Eigen::MatrixXd weights = Eigen::MatrixXd::Ones(u.value.size(), v.value.size());
    if (patch.weights.size() > 0) weights = part(patch.weights);
    const Eigen::RowVector3d below = sums(weights);
    Eigen::Matrix3d result;
    for (int k = 0; k < 3; ++k) {
        const Eigen::RowVector3d above = sums(part(patch.control[static_cast<std::size_t>(k)]).cwiseProduct(weights));
        const double value = above[0] / below[0];
        result.row(k) << value, (above[1] - value * below[1]) / below[0], (above[2] - value * below[2]) / below[0];
    }
    return result;
}

double height(const Patch& patch, const Eigen::Vector2d& xy)
{
    constexpr double outside = std::numeric_limits<double>::quiet_NaN();
    if (!xy.allFinite()) return outside;
    const Eigen::Matrix2d limits = domain(patch);
    const Eigen::Vector2d size = limits.col(1) - limits.col(0);
    Eigen::Vector2d uv = limits.rowwise().mean();
    for (int step = 0; step < kMostNewtonSteps; ++step) {
        // A point outside is approached along the edge; whether it is outside is seen at the end.
        const Eigen::Vector2d at = uv.cwiseMax(limits.col(0)).cwiseMin(limits.col(1));
        const Eigen::Matrix3d here = point_and_tangents(patch, at);
        const Eigen::Matrix2d tangents = here.block<2, 2>(0, 1);
        const Eigen::Vector2d next = at + tangents.fullPivLu().solve(xy - here.block<2, 1>(0, 0));
        const Eigen::Vector2d beyond = (limits.col(0) - next).cwiseMax(next - limits.col(1)).cwiseQuotient(size);
        const bool settled = (next - uv).cwiseQuotient(size).cwiseAbs().maxCoeff() < kRounding;
        uv = next;
        if (!settled) continue;
        if (beyond.maxCoeff() > kRounding) return outside;
        if (!patch.trim.empty() && !inside(outlines(patch), uv)) return outside;
        return point_and_tangents(patch, uv.cwiseMax(limits.col(0)).cwiseMin(limits.col(1)))(2, 0);
    }
    return outside;
}

} // namespace fettle
