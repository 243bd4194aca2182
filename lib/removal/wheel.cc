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

constexpr int kLanes = 4; // of Double4

/// How much stands above the rim, and in how many cells.
struct Sums {
    double height = 0;
    std::int64_t cells = 0;
};

/// The same of many rows, each by its share in the force.
struct Shares {
    double height = 0, lift = 0, area = 0, push = 0;
};

inline Sums row_above(const double* z, Eigen::Index count, double limit)
{
    Double4 height{};
    Mask4 cells{};
    Eigen::Index i = 0;
    for (; i + kLanes <= count; i += kLanes) {
        const Double4 over = *reinterpret_cast<const Double4*>(z + i) - limit;
        const Mask4 above = over > 0.0;
        height += reinterpret_cast<Double4>(reinterpret_cast<Mask4>(over) & above);
        cells -= above;
    }
    Sums sums{(height[0] + height[1]) + (height[2] + height[3]), (cells[0] + cells[1]) + (cells[2] + cells[3])};
    for (; i < count; ++i) {
        const double over = z[i] - limit;
        sums.height += over > 0 ? over : 0;
        sums.cells += over > 0 ? 1 : 0;
    }
    return sums;
}

inline void cut_row(double* z, Eigen::Index count, double limit)
{
    const Double4 limits = Double4{} + limit;
    Eigen::Index i = 0;
    for (; i + kLanes <= count; i += kLanes) {
        Double4& four = *reinterpret_cast<Double4*>(z + i);
        four = four > limits ? limits : four; // NaN stays
    }
    for (; i < count; ++i) z[i] = z[i] > limit ? limit : z[i];
}

inline double row_top(const double* z, Eigen::Index count)
{
    Double4 tops = Double4{} + kNothing;
    Eigen::Index i = 0;
    for (; i + kLanes <= count; i += kLanes) {
        const Double4 four = *reinterpret_cast<const Double4*>(z + i);
        tops = four > tops ? four : tops; // NaN is never greater
    }
    const auto greater = [](double a, double b) { return a > b ? a : b; }; // without a jump, unlike std::max
    double top = greater(greater(tops[0], tops[1]), greater(tops[2], tops[3]));
    for (; i < count; ++i) top = greater(z[i], top);
    return top;
}

/// @param rows  of the wheel; z_tip + profile is its rim there
FETTLE_CLONES Shares above(const std::vector<WheelInStock::Row>& rows, Eigen::Index columns, double z_tip)
{
    Shares sums;
    for (const WheelInStock::Row& row : rows) {
        const double limit = z_tip + row.profile;
        if (!(*row.top > limit)) continue;
        const Sums more = row_above(row.z, columns, limit);
        sums.height += more.height;
        sums.lift += row.lift * more.height;
        sums.area += row.lift * static_cast<double>(more.cells);
        sums.push += row.push * more.height;
    }
    return sums;
}

FETTLE_CLONES void cut_down(const std::vector<WheelInStock::Row>& rows, Eigen::Index columns, double z_tip)
{
    for (const WheelInStock::Row& row : rows) {
        const double limit = z_tip + row.profile;
        if (!(*row.top > limit)) continue;
        cut_row(row.z, columns, limit);
        *row.top = limit;
    }
}

/// @param z  first cell of the first row; the next row begins `stride` cells behind it
FETTLE_CLONES void find_tops(const double* z, Eigen::Index stride, Eigen::Index columns, Eigen::Index rows,
                             double* tops)
{
    for (Eigen::Index j = 0; j < rows; ++j) tops[j] = row_top(z + j * stride, columns);
}

/// The rows from first up to end whose top stands above the parabola lowest + y² curvature / 2.
/// @param tops  of all rows, and kLanes more numbers
/// @param at  of the parabola's vertex, in rows
/// @param rows  room for all of them, and kLanes more
/// @return how many they are
FETTLE_CLONES std::ptrdiff_t rows_above(const double* tops, Eigen::Index first, Eigen::Index end, double at,
                                        double cell, double curvature, double lowest, Eigen::Index* rows)
{
    std::ptrdiff_t count = 0;
    for (Eigen::Index j = first; j < end; j += kLanes) {
        const Double4 row = Double4{0.5, 1.5, 2.5, 3.5} + static_cast<double>(j);
        const Double4 y = (row - at) * cell;
        const Double4 top = *reinterpret_cast<const Double4*>(tops + j);
        const Mask4 above = top - y * y * curvature / 2 > lowest;
        for (int k = 0; k < kLanes; ++k) { // without jumps, too
            rows[count] = j + k;
            count -= above[k];
        }
    }
    while (count > 0 && rows[count - 1] >= end) --count;
    return count;
}

} // namespace

WheelInStock::WheelInStock(HeightField& stock, double width, const RimForce& rim)
    : stock_(stock), width_(width), rim_(rim), tops_(static_cast<std::size_t>(stock.rows()) + kLanes, kNothing),
      near_(tops_.size())
{
    find_tops(stock.z.data(), stock.columns(), stock.columns(), stock.rows(), tops_.data());
    highest_ = *std::max_element(tops_.begin(), tops_.end());
}

void WheelInStock::know_tops(Eigen::Index first, Eigen::Index end)
{
    const auto find = [this](Eigen::Index from, Eigen::Index to) {
        if (from < to)
            find_tops(&stock_.z(first_column_, from), stock_.columns(), columns_, to - from,
                      &tops_[static_cast<std::size_t>(from)]);
    };
    if (known_first_ == known_end_) known_first_ = known_end_ = first;
    find(first, known_first_);
    find(known_end_, end);
    known_first_ = std::min(first, known_first_);
    known_end_ = std::max(end, known_end_);
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
        known_first_ = known_end_ = 0;
    }
    const double rise = std::min(highest_ - lowest, radius); // the rim higher than this meets nothing
    if (columns_ == 0 || !(rise > 0)) return;

    const double curvature = 1 / radius;
    const double reach = std::sqrt(rise * (2 * radius - rise)) / stock_.cell;
    const Eigen::Index row_first = bounded(std::ceil(at.y() - reach - 0.5), stock_.rows());
    const Eigen::Index row_end = bounded(std::floor(at.y() + reach - 0.5) + 1, stock_.rows());
    know_tops(row_first, row_end);
    const std::ptrdiff_t count =
        rows_above(tops_.data(), row_first, row_end, at.y(), stock_.cell, curvature, lowest, near_.data());
    for (std::ptrdiff_t n = 0; n < count; ++n) { // the rim is above its parabola
        const Eigen::Index j = near_[static_cast<std::size_t>(n)];
        double& top = tops_[static_cast<std::size_t>(j)];
        const double y = (static_cast<double>(j) + 0.5 - at.y()) * stock_.cell;
        const double level = std::sqrt(std::max(radius * radius - y * y, 0.0));
        const double profile = y * y / (radius + level);
        if (!(top - profile > lowest)) continue;
        touch_ = std::max(touch_, top - profile);
        const double sine = y / radius, cosine = level / radius; // of the slope
        // A rim that is dragged into a wall carries no weight there; it does not pull the head down.
        const double lift = rim_.by_slope ? std::max(cosine + rim_.tangential * sine, 0.0) : 1;
        const double push = rim_.by_slope ? rim_.tangential * cosine - sine : 0;
        rows_.push_back({&stock_.z(first_column_, j), &top, profile, lift, push});
    }
}

WheelInStock::Overlap WheelInStock::overlap(double z_tip) const
{
    const Shares sums = above(rows_, columns_, z_tip);
    const double cell_area = stock_.cell * stock_.cell;
    return {sums.height * cell_area, sums.lift * cell_area, sums.area * cell_area, sums.push * cell_area};
}

void WheelInStock::cut(double z_tip) { cut_down(rows_, columns_, z_tip); }

} // namespace fettle
