#include "belt/layer_contact.h"

#include "belt/contact_preconditioner.h"
#include "core/error.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace fettle::belt {

using Eigen::ArrayXXd;
using Eigen::Index;
using Eigen::MatrixXd;

/// Cells that may be in contact.
struct LayerContact::Window {
    Index row = 0, column = 0, rows = 0, columns = 0;

    auto block(const MatrixXd& field) const { return field.block(row, column, rows, columns); }
    auto block(MatrixXd& field) const { return field.block(row, column, rows, columns); }
};

/// What the cells of a window lie over.
struct LayerContact::Workpiece {
    RemovalStep removal;
    ArrayXXd coverage;   ///< 1 where there is no workpiece; empty: 1 everywhere
    ArrayXXd compliance; ///< of partly covered cells, beyond that of whole ones, mm/MPa; empty as the coverage

    bool yields() const { return removal.scale > 0 || coverage.size() > 0; }
};

namespace {

constexpr int kMaxIterations = 1000;
// From a poor start the iteration may cycle; without a start it needs a few dozen iterations.
constexpr int kMaxIterationsFromStart = 100;

using Mask = Eigen::Array<bool, Eigen::Dynamic, Eigen::Dynamic>;

/// Slope of what is removed, own_gap(), weighted with the squares of the pressure, mm/MPa.
double mean_slope(const ArrayXXd& pressure, const ArrayXXd& own, const RemovalStep& removal)
{
    const double squares = pressure.square().sum();
    return squares > 0 ? removal.exponent * (own * pressure).sum() / squares : 0;
}

/// Preconditioned gap of the active cells, and its product with the gap. Neither has a mean where the force is known:
/// steps along them do not change it.
std::pair<ArrayXXd, double> preconditioned_gap(const ContactPreconditioner& preconditioner, const ArrayXXd& gap,
                                               const Mask& active, bool is_force_known)
{
    const auto on_active = [&](const ArrayXXd& field) -> ArrayXXd {
        const double mean = is_force_known ? active.select(field, 0).sum() / active.count() : 0;
        return active.select(field - mean, 0);
    };
    const ArrayXXd residual = on_active(gap);
    ArrayXXd direction = on_active(preconditioner(residual));
    const double energy = (residual * direction).sum();
    return {std::move(direction), energy};
}

/// First index and length of a window's side: the extent of the mask plus a margin, rounded up to a multiple of
/// kSizeMultiple so that few sizes of convolutions occur.
std::pair<Index, Index> window_side(const Eigen::Array<bool, Eigen::Dynamic, 1>& mask)
{
    constexpr Index kMarginCells = 2, kSizeMultiple = 8;
    Index first = 0, last = mask.size() - 1;
    while (first < last && !mask[first]) ++first;
    while (last > first && !mask[last]) --last;
    const Index extent = last - first + 1;
    const Index count =
        std::min((extent + 2 * kMarginCells + kSizeMultiple - 1) / kSizeMultiple * kSizeMultiple, mask.size());
    return {std::clamp<Index>(first - (count - extent) / 2, 0, mask.size() - count), count};
}

} // namespace

/// Winkler foundation with the stiffness of the layer under a pressure of the same extent.
MatrixXd LayerContact::initial_pressure(const MatrixXd& gap, const Contact& given, bool is_force_known) const
{
    const ElasticLayer& layer = surface_.layer();
    const auto winkler = [&](double depth) {
        const ArrayXXd compression = (depth - gap.array()).max(0);
        const double radius = std::sqrt((compression > 0).count() * surface_.cell_area() / std::numbers::pi);
        const double half_space =
            (1 - layer.poisson * layer.poisson) / layer.young * radius * 16 / (3 * std::numbers::pi);
        return MatrixXd(compression / std::min(half_space, layer.thickness / layer.young));
    };
    if (!is_force_known) return winkler(given.indentation);
    const double min_gap = gap.minCoeff();
    double high = std::min(layer.thickness, 1.0), low = 0; // bracket of the depth, mm
    while (winkler(min_gap + high).sum() * surface_.cell_area() < given.force) high *= 2;
    for (int i = 0; i < 12; ++i) {
        const double middle = (high + low) / 2;
        (winkler(min_gap + middle).sum() * surface_.cell_area() < given.force ? low : high) = middle;
    }
    const MatrixXd p = winkler(min_gap + high);
    return p * (given.force / (p.sum() * surface_.cell_area()));
}

/// The layer's displacement over the part f of a cell that carries its load, less that over the whole cell: those of
/// strips of a half-space, side 1 and f (Love 1929), of which the latter is the influence of the cell on itself.
ArrayXXd LayerContact::border_compliance(const ArrayXXd& coverage) const
{
    const ElasticLayer& layer = surface_.layer();
    const double cell = (1 - layer.poisson * layer.poisson) / (std::numbers::pi * layer.young) *
                        std::sqrt(surface_.cell_area()) * 2 * std::asinh(1) * 2;
    return coverage.unaryExpr([&](double f) {
        return f > 0 && f < 1 ? cell * ((std::asinh(1 / f) + std::asinh(f) / f) / (2 * std::asinh(1)) - 1) : 0;
    });
}

ArrayXXd LayerContact::own_gap(const Workpiece& workpiece, const ArrayXXd& pressure) const
{
    const RemovalStep& removal = workpiece.removal;
    const bool is_whole = workpiece.coverage.size() == 0;
    ArrayXXd depth;
    if (const FemLayer* fem = surface_.fem()) {
        const auto cosines = fem->tilt_cosines();
        depth = pressure.colwise() / cosines;
        if (!is_whole) depth /= workpiece.coverage;
        depth = depth.unaryExpr([&](double p) { return removal.depth(p); }).colwise() / cosines;
    } else if (removal.is_linear()) {
        if (is_whole) return removal.scale * pressure;
        return (removal.scale / workpiece.coverage + workpiece.compliance) * pressure;
    } else if (is_whole) {
        return pressure.unaryExpr([&](double p) { return removal.depth(p); });
    } else {
        depth = (pressure / workpiece.coverage).unaryExpr([&](double p) { return removal.depth(p); });
    }
    if (!is_whole) depth += workpiece.compliance * pressure;
    return depth;
}

double LayerContact::step_length(const ArrayXXd& pressure, const ArrayXXd& own, const MatrixXd& step,
                                 const Workpiece& workpiece, double slope, double curvature) const
{
    const auto s = step.array();
    if (workpiece.removal.is_linear())
        return -slope / (curvature + ((own_gap(workpiece, pressure + s) - own) * s).sum());
    const auto slope_at = [&](double length) {
        return slope + length * curvature + ((own_gap(workpiece, pressure + length * s) - own) * s).sum();
    };
    constexpr int kMaxIterations = 30;
    constexpr double kRelativeTolerance = 1e-3; // the step's direction is not better than this
    // The first length is that of Newton's method: a power of the pressure has its exponent times the power over the
    // pressure for a slope. Where the steps are short it is good enough.
    const double own_curvature =
        workpiece.removal.exponent * (pressure > 0).select(own / pressure * s.square(), 0).sum();
    double length = -slope / (curvature + own_curvature), found = slope_at(length);
    if (std::abs(found) <= kRelativeTolerance * std::abs(slope)) return length;
    // The slope of the energy grows along the step, so that the minimum is bracketed from the elastic solution down.
    double low = 0, high = -slope / curvature, slope_low = slope, slope_high = found < 0 ? slope_at(high) : found;
    (found < 0 ? low : high) = length;
    if (found < 0) slope_low = found;
    for (int k = 0; k < kMaxIterations && high - low > kRelativeTolerance * high; ++k) {
        const bool bisect = k % 3 == 2; // regula falsi alone may keep one end
        length = bisect ? (low + high) / 2 : low + (high - low) * slope_low / (slope_low - slope_high);
        found = slope_at(length);
        if (std::abs(found) <= kRelativeTolerance * std::abs(slope)) return length;
        (found < 0 ? low : high) = length;
        (found < 0 ? slope_low : slope_high) = found;
    }
    return (low + high) / 2;
}

/// Solves in the window and ignores the cells outside. @return  whether it converged
bool LayerContact::iterate(const MatrixXd& gap, const Window& window, double tolerance, const RemovalStep& removal,
                           const MatrixXd& coverage, bool is_force_known, int max_iterations, Contact& contact)
{
    const ArrayXXd undeformed =
        window.block(gap).array().isFinite().select(window.block(gap).array(), std::numeric_limits<double>::max());
    MatrixXd pressure = window.block(contact.pressure), displacement, step_displacement;
    MatrixXd step = MatrixXd::Zero(window.rows, window.columns);
    Workpiece workpiece{removal, {}, {}};
    if (coverage.size() > 0) {
        const ArrayXXd share = window.block(coverage).array();
        workpiece.coverage = (share > 0).select(share, 1);
        workpiece.compliance = border_compliance(workpiece.coverage);
    }
    ContactPreconditioner preconditioner; // of finite elements: they are softest to waves along both rows and columns
    if (!surface_.fem())
        preconditioner = ContactPreconditioner(surface_.influence().topLeftCorner(window.rows, window.columns));
    double last_energy = 0; // 0: restart along the gradient
    bool is_displacement_valid = false;
    for (; contact.iterations < max_iterations; ++contact.iterations) {
        auto p = pressure.array();
        if (!is_displacement_valid) displacement = surface_.of_window(pressure);
        is_displacement_valid = true;
        ArrayXXd open = undeformed + displacement.array(), own;
        if (workpiece.yields()) open += own = own_gap(workpiece, p);
        if (is_force_known) contact.indentation = (p > 0).select(open, 0).sum() / (p > 0).count();
        const ArrayXXd g = open - contact.indentation;
        if ((p * g).abs().maxCoeff() <= tolerance * p.maxCoeff() * contact.indentation &&
            g.minCoeff() >= -tolerance * contact.indentation) {
            window.block(contact.pressure) = pressure;
            return true;
        }
        const Mask active = p > 0 || g < 0;
        preconditioner.fit(workpiece.yields() ? mean_slope(p, own, removal) : 0);
        const auto [direction, energy] = preconditioned_gap(preconditioner, g, active, is_force_known);
        step = active.select((last_energy > 0 ? energy / last_energy : 0) * step.array() - direction, 0).matrix();
        last_energy = energy;
        step_displacement = surface_.of_window(step);
        ArrayXXd gradient_change = step_displacement.array();
        if (is_force_known) gradient_change -= active.select(gradient_change, 0).sum() / active.count();
        const double slope = (active.select(g, 0) * step.array()).sum();
        const double curvature = (gradient_change * step.array()).sum();
        const double length =
            workpiece.yields() ? step_length(p, own, step, workpiece, slope, curvature) : -slope / curvature;
        pressure += length * step;
        if (pressure.minCoeff() < 0) {
            pressure = pressure.cwiseMax(0);
            is_displacement_valid = false;
            last_energy = 0;
        } else {
            displacement += length * step_displacement;
        }
        if (is_force_known) {
            const double scale = contact.force / (pressure.sum() * surface_.cell_area());
            pressure *= scale;
            displacement *= scale;
        }
    }
    window.block(contact.pressure) = pressure;
    return false;
}

Contact LayerContact::solve(const MatrixXd& input_gap, const Contact& given, double tolerance, const MatrixXd& start,
                            const RemovalStep& removal, const MatrixXd& coverage, bool is_force_known)
{
    Contact contact = given;
    MatrixXd gap = input_gap;
    const FemLayer* fem = surface_.fem();
    if (fem) gap.array().colwise() /= fem->tilt_cosines();
    const double first_touch = gap.minCoeff(); // indentation
    gap.array() -= first_touch;
    contact.indentation -= first_touch;
    if (!is_force_known && !(contact.indentation > 0)) { // no contact
        contact.indentation += first_touch;
        contact.pressure = MatrixXd::Zero(gap.rows(), gap.cols());
        contact.converged = true;
        return contact;
    }
    contact.pressure = start.size() > 0 ? start.cwiseMax(0).eval() : initial_pressure(gap, contact, is_force_known);
    if (fem && start.size() > 0) contact.pressure.array().colwise() *= fem->tilt_cosines();
    contact.pressure = gap.array().isFinite().select(contact.pressure, 0);
    if (is_force_known) {
        if (!(contact.pressure.sum() > 0)) contact.pressure = initial_pressure(gap, contact, is_force_known);
        contact.pressure *= contact.force / (contact.pressure.sum() * surface_.cell_area());
    }
    Mask may_touch = contact.pressure.array() > 0;
    if (!is_force_known) may_touch = may_touch || gap.array() < contact.indentation;
    contact.converged = true;
    while (contact.converged) {
        Window window{0, 0, gap.rows(), gap.cols()};
        if (!fem) {
            std::tie(window.row, window.rows) = window_side(may_touch.rowwise().any());
            std::tie(window.column, window.columns) = window_side(may_touch.colwise().any().transpose());
        }
        if (surface_.has_sides()) { // as wide on either side of the middle
            window.column = std::min(window.column, gap.cols() - window.column - window.columns);
            window.columns = gap.cols() - 2 * window.column;
        }
        contact.converged = iterate(gap, window, tolerance, removal, coverage, is_force_known,
                                    start.size() > 0 ? kMaxIterationsFromStart : kMaxIterations, contact);
        const double bulge =
            surface_.min_influence() * contact.pressure.sum(); // lower bound of the displacement at any cell
        const double open = contact.indentation * (1 - tolerance) - bulge;
        const auto outside_window = [&](Mask mask) {
            mask.block(window.row, window.column, window.rows, window.columns) = false;
            return mask;
        };
        if (!outside_window(gap.array() < open).any()) break;
        const Mask interpenetrating =
            outside_window(signed_gap(gap, contact, coverage).array() < -tolerance * contact.indentation);
        if (!interpenetrating.any()) break;
        may_touch = may_touch || interpenetrating;
    }
    if (!contact.converged && start.size() > 0)
        return solve(input_gap, given, tolerance, {}, removal, coverage, is_force_known);
    contact.indentation += first_touch;
    contact.force = contact.pressure.sum() * surface_.cell_area();
    if (fem) contact.pressure.array().colwise() /= fem->tilt_cosines();
    return contact;
}

MatrixXd LayerContact::signed_gap(const MatrixXd& gap, const Contact& contact, const MatrixXd& coverage)
{
    MatrixXd displacement = surface_.radial(contact.pressure);
    ArrayXXd indentation = ArrayXXd::Constant(gap.rows(), gap.cols(), contact.indentation);
    if (const FemLayer* fem = surface_.fem()) indentation.colwise() *= fem->tilt_cosines();
    if (coverage.size() > 0) displacement.array() += border_compliance(coverage.array()) * contact.pressure.array();
    return gap + (displacement.array() - indentation).matrix();
}

MatrixXd LayerContact::residual_gap(const MatrixXd& gap, const Contact& contact, const MatrixXd& coverage)
{
    return signed_gap(gap, contact, coverage).cwiseMax(0);
}

Contact LayerContact::solve_by_indentation(const MatrixXd& gap, double indentation, double tolerance,
                                           const MatrixXd& start, const RemovalStep& removal, const MatrixXd& coverage)
{
    Contact contact;
    contact.indentation = indentation;
    return solve(gap, contact, tolerance, start, removal, coverage, false);
}

Contact LayerContact::solve_by_force(const MatrixXd& gap, double force, double tolerance, const MatrixXd& start,
                                     const RemovalStep& removal, const MatrixXd& coverage)
{
    if (!gap.array().isFinite().any()) throw core::InputError("contact", "no workpiece under the wheel");
    Contact contact;
    contact.force = force;
    return solve(gap, contact, tolerance, start, removal, coverage, true);
}

} // namespace fettle::belt
