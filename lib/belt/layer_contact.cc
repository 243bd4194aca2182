#include "belt/layer_contact.h"

#include "core/error.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace fettle {

using Eigen::ArrayXXd;
using Eigen::Index;
using Eigen::MatrixXd;

/// The cells that may touch.
struct LayerContact::Window {
    Index row = 0, column = 0, rows = 0, columns = 0;

    auto of(const MatrixXd& field) const { return field.block(row, column, rows, columns); }
    auto of(MatrixXd& field) const { return field.block(row, column, rows, columns); }
};

namespace {

constexpr int kMostIterations = 1000;
// A start that is far off may lead round in circles; from no start it takes a few dozen.
constexpr int kMostFromStart = 100;

using Marks = Eigen::Array<bool, Eigen::Dynamic, Eigen::Dynamic>;

/// Of all cells that are marked.
std::pair<Index, Index> extent(const Eigen::Array<bool, Eigen::Dynamic, 1>& marks)
{
    Index first = 0, last = marks.size() - 1;
    while (first < last && !marks[first]) ++first;
    while (last > first && !marks[last]) --last;
    return {first, last};
}

/// A window's side: as many cells as marked ones and two around, in steps, so that few sizes come up.
std::pair<Index, Index> side(const Eigen::Array<bool, Eigen::Dynamic, 1>& marks)
{
    constexpr Index kAround = 2, kStep = 8;
    const auto [first, last] = extent(marks);
    const Index wanted = (last - first + 1 + 2 * kAround + kStep - 1) / kStep * kStep;
    const Index count = std::min(wanted, marks.size());
    return {std::clamp<Index>(first - (count - (last - first + 1)) / 2, 0, marks.size() - count), count};
}

} // namespace

LayerContact::LayerContact(const ElasticLayer& layer, const Eigen::Vector2d& cell, Index rows, Index columns)
    : layer_(layer), cell_area_(cell.prod()), influence_(influence(layer, cell, rows, columns)),
      least_influence_(std::min(influence_.minCoeff(), 0.0))
{
}

LayerContact::LayerContact(const LayerMesh& mesh, Index rows)
    : layer_(mesh.layer), cell_area_(mesh.cell.prod()), least_influence_(0), fem_(std::in_place, mesh, rows)
{
}

Convolution& LayerContact::convolution(Index rows, Index columns)
{
    const auto found = convolutions_.find({rows, columns});
    if (found != convolutions_.end()) return found->second;
    return convolutions_.emplace(std::pair(rows, columns), Convolution(influence_.topLeftCorner(rows, columns)))
        .first->second;
}

/// Of the finite elements it is told along the middle's radius: what pressure along each row's own radius comes to
/// there.
void LayerContact::give(const MatrixXd& pressure, MatrixXd& displacement)
{
    if (!fem_) return convolution(pressure.rows(), pressure.cols())(pressure, displacement);
    const auto upright = fem_->upright();
    displacement = fem_->displacement((pressure.array().colwise() / upright).matrix());
    displacement.array().colwise() /= upright;
}

/// Winkler's springs, as stiff as the layer is under a pressure that spreads as far as theirs.
MatrixXd LayerContact::guess(const MatrixXd& gap, const Contact& wanted, bool is_force_known) const
{
    const auto pressed = [&](double depth) {
        const ArrayXXd deep = (depth - gap.array()).max(0);
        const double radius = std::sqrt(static_cast<double>((deep > 0).count()) * cell_area_ / std::numbers::pi);
        const double half_space =
            (1 - layer_.poisson * layer_.poisson) / layer_.young * radius * 16 / (3 * std::numbers::pi);
        return MatrixXd(deep / std::min(half_space, layer_.thickness / layer_.young));
    };
    if (!is_force_known) return pressed(wanted.indentation);
    const double least = gap.minCoeff();
    double above = layer_.thickness < 1 ? layer_.thickness : 1, below = 0; // mm
    while (pressed(least + above).sum() * cell_area_ < wanted.force) above *= 2;
    for (int i = 0; i < 12; ++i) {
        const double middle = (above + below) / 2;
        (pressed(least + middle).sum() * cell_area_ < wanted.force ? below : above) = middle;
    }
    const MatrixXd p = pressed(least + above);
    return p * (wanted.force / (p.sum() * cell_area_));
}

/// Solves in the window, whatever is beyond it. @return  whether to tolerance
bool LayerContact::iterate(const MatrixXd& gap, const Window& window, double tolerance, bool is_force_known,
                           int most_iterations, Contact& contact)
{
    const ArrayXXd before = window.of(gap).array();
    const Marks there = before.isFinite();
    MatrixXd pressure = window.of(contact.pressure), displacement, give_of_step;
    MatrixXd step = MatrixXd::Zero(window.rows, window.columns);
    double last = 0; // squares of the gaps; 0: the next step is along the gaps
    bool known = false;
    for (; contact.iterations < most_iterations; ++contact.iterations) {
        auto p = pressure.array();
        if (!known) give(pressure, displacement);
        known = true;
        const ArrayXXd open = there.select(before + displacement.array(), std::numeric_limits<double>::max());
        if (is_force_known) contact.indentation = (p > 0).select(open, 0).sum() / static_cast<double>((p > 0).count());
        const ArrayXXd g = open - contact.indentation;
        if ((p * g).abs().maxCoeff() <= tolerance * p.maxCoeff() * contact.indentation &&
            g.minCoeff() >= -tolerance * contact.indentation) {
            window.of(contact.pressure) = pressure;
            return true;
        }
        const Marks free = p > 0 || g < 0;
        const double squares = free.select(g.square(), 0).sum();
        step = free.select((last > 0 ? squares / last : 0) * step.array() - g, 0).matrix();
        last = squares;
        give(step, give_of_step);
        ArrayXXd resists = give_of_step.array();
        if (is_force_known) resists -= free.select(resists, 0).sum() / static_cast<double>(free.count());
        const double length = -(free.select(g, 0) * step.array()).sum() / (resists * step.array()).sum();
        pressure += length * step;
        const bool clipped = pressure.minCoeff() < 0;
        if (clipped) {
            pressure = pressure.cwiseMax(0);
            known = false;
            last = 0;
        } else {
            displacement += length * give_of_step;
        }
        if (is_force_known) {
            const double scale = contact.force / (pressure.sum() * cell_area_);
            pressure *= scale;
            displacement *= scale;
        }
    }
    window.of(contact.pressure) = pressure;
    return false;
}

Contact LayerContact::solve(const MatrixXd& from_the_plane, const Contact& wanted, double tolerance,
                            const MatrixXd& start, bool is_force_known)
{
    Contact contact = wanted;
    MatrixXd gap = from_the_plane;
    if (fem_) gap.array().colwise() /= fem_->upright();
    const double first = gap.minCoeff(); // where the hub stands when it first touches
    gap.array() -= first;
    contact.indentation -= first;
    if (!is_force_known && !(contact.indentation > 0)) { // nothing touches
        contact.indentation += first;
        contact.pressure = MatrixXd::Zero(gap.rows(), gap.cols());
        contact.converged = true;
        return contact;
    }
    contact.pressure = start.size() > 0 ? start.cwiseMax(0).eval() : guess(gap, contact, is_force_known);
    if (fem_ && start.size() > 0) contact.pressure.array().colwise() *= fem_->upright();
    contact.pressure = gap.array().isFinite().select(contact.pressure, 0);
    if (is_force_known) {
        if (!(contact.pressure.sum() > 0)) contact.pressure = guess(gap, contact, is_force_known);
        contact.pressure *= contact.force / (contact.pressure.sum() * cell_area_);
    }
    Marks touched = contact.pressure.array() > 0;
    if (!is_force_known) touched = touched || gap.array() < contact.indentation;
    contact.converged = true;
    while (contact.converged) {
        Window window{0, 0, gap.rows(), gap.cols()};
        if (!fem_) {
            std::tie(window.row, window.rows) = side(touched.rowwise().any());
            std::tie(window.column, window.columns) = side(touched.colwise().any().transpose());
        }
        contact.converged = iterate(gap, window, tolerance, is_force_known,
                                    start.size() > 0 ? kMostFromStart : kMostIterations, contact);
        const double bulge = least_influence_ * contact.pressure.sum(); // at most, anywhere
        const double open = contact.indentation * (1 - tolerance) - bulge;
        const auto beyond = [&](Marks marks) {
            marks.block(window.row, window.column, window.rows, window.columns) = false;
            return marks;
        };
        if (!beyond(gap.array() < open).any()) break;
        const Marks crossed = beyond(left(gap, contact).array() < -tolerance * contact.indentation);
        if (!crossed.any()) break;
        touched = touched || crossed;
    }
    if (!contact.converged && start.size() > 0) return solve(from_the_plane, wanted, tolerance, {}, is_force_known);
    contact.indentation += first;
    contact.force = contact.pressure.sum() * cell_area_;
    if (fem_) contact.pressure.array().colwise() /= fem_->upright();
    return contact;
}

MatrixXd LayerContact::left(const MatrixXd& gap, const Contact& contact)
{
    if (fem_)
        return gap + fem_->displacement(contact.pressure) -
               (contact.indentation * fem_->upright()).matrix().replicate(1, gap.cols());
    MatrixXd displacement;
    give(contact.pressure, displacement);
    return gap + (displacement.array() - contact.indentation).matrix();
}

MatrixXd LayerContact::gap_left(const MatrixXd& gap, const Contact& contact) { return left(gap, contact).cwiseMax(0); }

Contact LayerContact::by_depth(const MatrixXd& gap, double indentation, double tolerance, const MatrixXd& start)
{
    Contact contact;
    contact.indentation = indentation;
    return solve(gap, contact, tolerance, start, false);
}

Contact LayerContact::by_force(const MatrixXd& gap, double force, double tolerance, const MatrixXd& start)
{
    if (!gap.array().isFinite().any()) throw InputError("contact", "there is nothing to touch");
    Contact contact;
    contact.force = force;
    return solve(gap, contact, tolerance, start, true);
}

} // namespace fettle
