#include "surface/patches.h"

#include "core/constants.h"
#include "job/boundary.h"
#include "surface/basis.h"
#include "units/units.h"
#include "json/document.h"
#include "json/units.h"

#include <Eigen/LU>

#include <cmath>

namespace fettle::surface {

namespace {

constexpr int kMaxDegree = 7;
// Newton's method doubles the number of correct digits in each step; a patch that needs more steps is folded.
constexpr int kMaxNewtonSteps = 50;
// Rounding of u and v, relative to the domain: convergence of the steps, and allowance outside the domain.
constexpr double kParameterTolerance = 1e-12;
// Chords per span of a trimming curve. Over a quarter of a circle the sagitta is (π/2/64)²/8 of the radius.
constexpr int kChordsPerSpan = 64;
// Maximum gap between the ends of a closed curve, relative to the domain: coordinates in files may have six digits.
constexpr double kClosureTolerance = 1e-5;

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
    const BasisFunctions basis = basis_functions(curve.knots, curve.degree, t);
    Eigen::VectorXd weights = basis.value;
    if (curve.weights.size() > 0) weights.array() *= curve.weights.segment(basis.first, weights.size()).array();
    return curve.control.middleCols(basis.first, weights.size()) * weights / weights.sum();
}

TrimCurve read_trim(json::Reader reader, const Patch& patch)
{
    TrimCurve curve;
    curve.degree = reader.integer("degree", 1, kMaxDegree);
    curve.control = reader.matrix("control", 2).transpose();
    curve.knots = read_knots(reader, "knots", curve.degree, curve.control.cols());
    if (!reader.is_null_or_missing("weights")) {
        curve.weights = reader.vector("weights", curve.control.cols());
        if (curve.weights.minCoeff() <= 0) reader.refuse("weights", "must be positive");
    }
    const Eigen::Matrix2d limits = parameter_domain(patch);
    const Eigen::Vector2d size = limits.col(1) - limits.col(0);
    for (Eigen::Index i = 0; i < curve.control.cols(); ++i) {
        const Eigen::Vector2d uv = curve.control.col(i);
        if (((limits.col(0) - uv).cwiseMax(uv - limits.col(1)).array() > kParameterTolerance * size.array()).any())
            reader.refuse("control[" + std::to_string(i) + "]", "lies outside the knots of u or v");
        curve.control.col(i) = uv.cwiseMax(limits.col(0)).cwiseMin(limits.col(1));
    }
    const Eigen::Index last = curve.knots.size() - curve.degree - 1;
    const Eigen::Vector2d gap = point(curve, curve.knots[last]) - point(curve, curve.knots[curve.degree]);
    if ((gap.cwiseQuotient(size).cwiseAbs().array() > kClosureTolerance).any())
        reader.refuse("control", "is not closed: it ends elsewhere than it begins");
    reader.reject_unknown_keys();
    return curve;
}

Patch read_patch(json::Reader reader, double mm)
{
    Patch patch;
    const Eigen::VectorXd degree = reader.vector("degree", 2);
    for (const double d : degree)
        if (d < 1 || d > kMaxDegree || d != std::floor(d))
            reader.refuse("degree", "must be whole numbers from 1 to " + std::to_string(kMaxDegree));
    patch.degree_u = degree[0];
    patch.degree_v = degree[1];
    const std::vector<Eigen::MatrixXd> control = reader.grid("control", 3);
    for (std::size_t k = 0; k < 3; ++k) patch.control[k] = control[k] * mm;
    patch.knots_u = read_knots(reader, "knots_u", patch.degree_u, control[0].rows());
    patch.knots_v = read_knots(reader, "knots_v", patch.degree_v, control[0].cols());
    if (!reader.is_null_or_missing("weights")) {
        patch.weights = reader.matrix("weights", control[0].cols());
        if (patch.weights.rows() != control[0].rows()) reader.refuse("weights", "one row for each row of control");
        if (patch.weights.minCoeff() <= 0) reader.refuse("weights", "must be positive");
    }
    if (!reader.is_null_or_missing("trim"))
        for (json::Reader& curve : reader.objects("trim")) patch.trim.push_back(read_trim(std::move(curve), patch));
    reader.reject_unknown_keys();
    return patch;
}

std::vector<Patch> parse_patches(json::Reader reader)
{
    reader.expect_kind("patches");
    const double mm = units::mm_per(json::read_length_unit(reader));
    std::vector<Patch> patches;
    for (const json::Reader& patch : reader.objects("patches")) patches.push_back(read_patch(patch, mm));
    if (patches.empty()) reader.refuse("patches", "there is none");
    reader.reject_unknown_keys();
    return patches;
}

} // namespace

std::vector<Patch> read_patches(const std::string& path) { return parse_patches(json::Reader::open(path)); }

std::vector<Patch> parse_patches(std::string_view text, const std::string& source)
{
    return parse_patches(json::Reader::parse(text, source));
}

Eigen::Matrix2d parameter_domain(const Patch& patch)
{
    const auto limits = [](const Eigen::VectorXd& knots, int degree) {
        return Eigen::RowVector2d(knots[degree], knots[knots.size() - degree - 1]);
    };
    return (Eigen::Matrix2d() << limits(patch.knots_u, patch.degree_u), limits(patch.knots_v, patch.degree_v))
        .finished();
}

std::vector<Eigen::Matrix2Xd> boundary_polygons(const Patch& patch)
{
    if (patch.trim.empty()) {
        const Eigen::Matrix2d limits = parameter_domain(patch);
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
            const int chords = curve.degree == 1 && curve.weights.size() == 0 ? 1 : kChordsPerSpan;
            for (int i = 0; i < chords && from < to; ++i)
                points.push_back(point(curve, from + (to - from) * i / chords));
        }
        points.push_back(Eigen::Vector2d(points.front()));
        polygons.push_back(job::columns_to_matrix(points));
    }
    return polygons;
}

bool is_inside(const std::vector<Eigen::Matrix2Xd>& outlines, const Eigen::Vector2d& uv)
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
    const BasisFunctions u = basis_functions(patch.knots_u, patch.degree_u, uv.x());
    const BasisFunctions v = basis_functions(patch.knots_v, patch.degree_v, uv.y());
    const auto part = [&](const Eigen::MatrixXd& net) {
        return net.block(u.first, v.first, u.value.size(), v.value.size());
    };
    // Element 0 is the weighted sum of the net, elements 1 and 2 are its derivatives in u and v.
    const auto sums = [&](const Eigen::MatrixXd& net) {
        return Eigen::RowVector3d(u.value.dot(net * v.value), u.derivative.dot(net * v.value),
                                  u.value.dot(net * v.derivative));
    };
    Eigen::MatrixXd weights = Eigen::MatrixXd::Ones(u.value.size(), v.value.size());
    if (patch.weights.size() > 0) weights = part(patch.weights);
    const Eigen::RowVector3d denominator = sums(weights);
    Eigen::Matrix3d result;
    for (int k = 0; k < 3; ++k) {
        const Eigen::RowVector3d numerator = sums(part(patch.control[k]).cwiseProduct(weights));
        const double value = numerator[0] / denominator[0];
        result.row(k) << value, (numerator[1] - value * denominator[1]) / denominator[0],
            (numerator[2] - value * denominator[2]) / denominator[0];
    }
    return result;
}

double height(const Patch& patch, const Eigen::Vector2d& xy)
{
    if (!xy.allFinite()) return core::kNaN;
    const Eigen::Matrix2d limits = parameter_domain(patch);
    const Eigen::Vector2d size = limits.col(1) - limits.col(0);
    Eigen::Vector2d uv = limits.rowwise().mean();
    for (int step = 0; step < kMaxNewtonSteps; ++step) {
        // Evaluates at the nearest point of the domain; whether xy is outside is decided after convergence.
        const Eigen::Vector2d at = uv.cwiseMax(limits.col(0)).cwiseMin(limits.col(1));
        const Eigen::Matrix3d here = point_and_tangents(patch, at);
        const Eigen::Matrix2d tangents = here.block<2, 2>(0, 1);
        const Eigen::Vector2d next = at + tangents.fullPivLu().solve(xy - here.block<2, 1>(0, 0));
        const Eigen::Vector2d beyond = (limits.col(0) - next).cwiseMax(next - limits.col(1)).cwiseQuotient(size);
        const bool converged = (next - uv).cwiseQuotient(size).cwiseAbs().maxCoeff() < kParameterTolerance;
        uv = next;
        if (!converged) continue;
        if (beyond.maxCoeff() > kParameterTolerance) return core::kNaN;
        if (!patch.trim.empty() && !is_inside(boundary_polygons(patch), uv)) return core::kNaN;
        return point_and_tangents(patch, uv.cwiseMax(limits.col(0)).cwiseMin(limits.col(1)))(2, 0);
    }
    return core::kNaN;
}

} // namespace fettle::surface
