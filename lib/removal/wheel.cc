#include "removal/wheel.h"

#include "core/simd.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fettle {
namespace {

constexpr double kNothing = -std::numeric_limits<double>::infinity();
/// A cell's centre that lies on the wheel's side face but for rounding belongs to the side of greater x, so that the
/// same job elsewhere on the table grinds the same cells.
constexpr double kOnFace = 1e-6; // of a cell

/// Sums of one row: how much stands above `limit`, and in how many cells.
struct RowSums {
    double height = 0;
    std::int64_t cells = 0;
};

FETTLE_CLONES RowSums row_above(const double* z, Eigen::Index count, double limit)
{
    Double4 height{};
    Mask4 cells{};
    Eigen::Index i = 0;
    for (; i + 4 <= count; i += 4) {
        const Double4 over = *reinterpret_cast<const Double4*>(z + i) - limit;
        const Mask4 above = over > 0.0;
        height += reinterpret_cast<Double4>(reinterpret_cast<Mask4>(over) & above);
        cells -= above;
    }
    RowSums sums{(height[0] + height[1]) + (height[2] + height[3]), (cells[0] + cells[1]) + (cells[2] + cells[3])};
    for (; i < count; ++i)
        if (z[i] > limit) {
            sums.height += z[i] - limit;
            ++sums.cells;
        }
    return sums;
}

FETTLE_CLONES void cut_row(double* z, Eigen::Index count, double limit)
{
    const Double4 limits = Double4{} + limit;
    Eigen::Index i = 0;
    for (; i + 4 <= count; i += 4) {
        Double4& four = *reinterpret_cast<Double4*>(z + i);
        four = four > limits ? limits : four; // NaN stays
    }
    for (; i < count; ++i) z[i] = z[i] > limit ? limit : z[i];
}

FETTLE_CLONES double highest(const double* z, Eigen::Index count)
{
    Double4 tops = Double4{} + kNothing;
    Eigen::Index i = 0;
    for (; i + 4 <= count; i += 4) {
        const Double4 four = *reinterpret_cast<const Double4*>(z + i);
        tops = four > tops ? four : tops; // NaN is never greater
    }
    double top = std::max(std::max(tops[0], tops[1]), std::max(tops[2], tops[3]));
    for (; i < count; ++i) top = z[i] > top ? z[i] : top;
    return top;
}

} // namespace

WheelInStock::WheelInStock(HeightField& stock, double width)
    : stock_(stock), width_(width), highest_(highest(stock.z.data(), stock.z.size())),
      tops_(static_cast<std::size_t>(stock.rows()), kNothing), known_(static_cast<std::size_t>(stock.rows()), -1)
{
}

double WheelInStock::top(Eigen::Index row)
{
    const std::size_t r = static_cast<std::size_t>(row);
    if (known_[r] != visit_) {
        known_[r] = visit_;
        tops_[r] = highest(&stock_.z(first_column_, row), columns_);
    }
    return tops_[r];
}

void WheelInStock::place(const Eigen::Vector2d& xy, double radius, double lowest)
{
    rows_.clear();
    touch_ = kNothing;
    const Eigen::Vector2d at = (xy - stock_.origin) / stock_.cell; // in cells; centres at i + 1/2
    const double half = width_ / 2 / stock_.cell;
    const auto bounded = [](double cell, Eigen::Index count) {
        return static_cast<Eigen::Index>(std::clamp(cell, 0.0, static_cast<double>(count)));
    };
    const Eigen::Index first = bounded(std::ceil(at.x() - half - 0.5 - kOnFace), stock_.columns());
    const Eigen::Index end = bounded(std::ceil(at.x() + half - 0.5 - kOnFace), stock_.columns());
    if (first != first_column_ || end - first != columns_) {
        first_column_ = first;
        columns_ = end - first;
        ++visit_;
    }
    const double rise = std::min(highest_ - lowest, radius); // the rim higher than this meets nothing
    if (columns_ == 0 || !(rise > 0)) return;

    const double curvature = 1 / radius;
    const double reach = std::sqrt(rise * (2 * radius - rise)) / stock_.cell;
    const Eigen::Index row_end = bounded(std::floor(at.y() + reach - 0.5) + 1, stock_.rows());
    for (Eigen::Index j = bounded(std::ceil(at.y() - reach - 0.5), stock_.rows()); j < row_end; ++j) {
        const double y = (static_cast<double>(j) + 0.5 - at.y()) * stock_.cell;
        const double row_top = top(j);
        if (!(row_top - y * y * curvature / 2 > lowest)) continue; // the rim is above its parabola
        const double profile = y * y / (radius + std::sqrt(std::max(radius * radius - y * y, 0.0)));
        if (!(row_top - profile > lowest)) continue;
        touch_ = std::max(touch_, row_top - profile);
        rows_.push_back({&stock_.z(first_column_, j), &tops_[static_cast<std::size_t>(j)], profile});
    }
}

WheelInStock::Overlap WheelInStock::overlap(double z_tip) const
{
    double height = 0;
    std::int64_t cells = 0;
    for (const Row& row : rows_) {
        const double limit = z_tip + row.profile;
        if (!(*row.top > limit)) continue;
        const RowSums sums = row_above(row.z, columns_, limit);
        height += sums.height;
        cells += sums.cells;
    }
    const double cell_area = stock_.cell * stock_.cell;
    return {height * cell_area, static_cast<double>(cells) * cell_area};
}

void WheelInStock::cut(double z_tip)
{
    for (const Row& row : rows_) {
        const double limit = z_tip + row.profile;
        if (!(*row.top > limit)) continue;
        cut_row(row.z, columns_, limit);
        *row.top = limit;
    }
}

} // namespace fettle
