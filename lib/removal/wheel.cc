#include "removal/wheel.h"

#include "core/simd.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fettle::removal {
namespace {

constexpr double kNoMaterial = -std::numeric_limits<double>::infinity();
/// A cell's centre this close to the wheel's side face counts as on the side of greater x, so that the same job
/// elsewhere on the table grinds the same cells. The strategy's positions are those of a trace, whose floats resolve
/// 3e-5 mm at 500 mm: some ten thousandths of a cell.
constexpr double kFaceToleranceCells = 1e-3;

constexpr int kLanes = 4; // of Double4

/// Sum of the heights above the rim, and number of cells that reach above it.
struct RowOverlap {
    double height = 0;
    std::int64_t cells = 0;
};

/// Sums over rows, weighted with their force ratios.
struct WeightedOverlap {
    double height = 0, lift = 0, area = 0, push = 0;
};

inline RowOverlap overlap_of_row(const double* z, Eigen::Index count, double limit)
{
    core::Double4 height{};
    core::Mask4 cells{};
    Eigen::Index i = 0;
    for (; i + kLanes <= count; i += kLanes) {
        const core::Double4 over = *reinterpret_cast<const core::Double4*>(z + i) - limit;
        const core::Mask4 above = over > 0.0;
        height += reinterpret_cast<core::Double4>(reinterpret_cast<core::Mask4>(over) & above);
        cells -= above;
    }
    RowOverlap sums{(height[0] + height[1]) + (height[2] + height[3]), (cells[0] + cells[1]) + (cells[2] + cells[3])};
    for (; i < count; ++i) {
        const double over = z[i] - limit;
        sums.height += over > 0 ? over : 0;
        sums.cells += over > 0 ? 1 : 0;
    }
    return sums;
}

inline void cut_row(double* z, Eigen::Index count, double limit)
{
    const core::Double4 limits = core::broadcast(limit);
    Eigen::Index i = 0;
    for (; i + kLanes <= count; i += kLanes) {
        core::Double4& four = *reinterpret_cast<core::Double4*>(z + i);
        four = four > limits ? limits : four; // NaN stays
    }
    for (; i < count; ++i) z[i] = z[i] > limit ? limit : z[i];
}

inline double top_of_row(const double* z, Eigen::Index count)
{
    core::Double4 tops = core::broadcast(kNoMaterial);
    Eigen::Index i = 0;
    for (; i + kLanes <= count; i += kLanes) {
        const core::Double4 four = *reinterpret_cast<const core::Double4*>(z + i);
        tops = four > tops ? four : tops; // NaN is never greater
    }
    const auto greater = [](double a, double b) { return a > b ? a : b; }; // compiles without a branch, unlike std::max
    double top = greater(greater(tops[0], tops[1]), greater(tops[2], tops[3]));
    for (; i < count; ++i) top = greater(z[i], top);
    return top;
}

FETTLE_CLONES WeightedOverlap overlap_of_rows(const std::vector<WheelInStock::Row>& rows, Eigen::Index columns,
                                              double z_tip)
{
    WeightedOverlap sums;
    for (const WheelInStock::Row& row : rows) {
        const double limit = z_tip + row.profile;
        if (!(*row.top > limit)) continue;
        const auto [height, cells] = overlap_of_row(row.z, columns, limit);
        sums.height += height;
        sums.lift += row.lift * height;
        sums.area += row.lift * cells;
        sums.push += row.push * height;
    }
    return sums;
}

FETTLE_CLONES void cut_rows(const std::vector<WheelInStock::Row>& rows, Eigen::Index columns, double z_tip)
{
    for (const WheelInStock::Row& row : rows) {
        const double limit = z_tip + row.profile;
        if (!(*row.top > limit)) continue;
        cut_row(row.z, columns, limit);
        *row.top = limit;
    }
}

/// @param z  first cell of the first row; the next row begins `stride` cells after it
FETTLE_CLONES void find_tops(const double* z, Eigen::Index stride, Eigen::Index columns, Eigen::Index rows,
                             double* tops)
{
    for (Eigen::Index j = 0; j < rows; ++j) tops[j] = top_of_row(z + j * stride, columns);
}

/// Finds the rows from `first` up to `end` whose top reaches above the parabola lowest + y² curvature / 2.
/// @param tops    of all rows, padded by kLanes numbers
/// @param vertex  position of the parabola's vertex, in rows
/// @param rows    output; room for all rows and kLanes more
/// @return  how many were found
FETTLE_CLONES std::ptrdiff_t rows_above(const double* tops, Eigen::Index first, Eigen::Index end, double vertex,
                                        double cell, double curvature, double lowest, Eigen::Index* rows)
{
    std::ptrdiff_t count = 0;
    for (Eigen::Index j = first; j < end; j += kLanes) {
        const core::Double4 row = core::Double4{0.5, 1.5, 2.5, 3.5} + double(j);
        const core::Double4 y = (row - vertex) * cell;
        const core::Double4 top = *reinterpret_cast<const core::Double4*>(tops + j);
        const core::Mask4 above = top - y * y * curvature / 2 > lowest;
        for (int k = 0; k < kLanes; ++k) { // without a branch, too
            rows[count] = j + k;
            count -= above[k];
        }
    }
    while (count > 0 && rows[count - 1] >= end) --count;
    return count;
}

} // namespace

WheelInStock::WheelInStock(HeightField& stock, double width, const RimForce& rim)
    : stock_(stock), width_(width), rim_(rim), row_tops_(stock.rows() + kLanes, kNoMaterial),
      candidate_rows_(row_tops_.size())
{
    find_tops(stock.z.data(), stock.columns(), stock.columns(), stock.rows(), row_tops_.data());
    max_height_ = *std::max_element(row_tops_.begin(), row_tops_.end());
}

void WheelInStock::update_row_tops(Eigen::Index first, Eigen::Index end)
{
    const auto find = [this](Eigen::Index from, Eigen::Index to) {
        if (from < to)
            find_tops(&stock_.z(first_column_, from), stock_.columns(), columns_, to - from, &row_tops_[from]);
    };
    if (tops_first_ == tops_end_) tops_first_ = tops_end_ = first;
    find(first, tops_first_);
    find(tops_end_, end);
    tops_first_ = std::min(first, tops_first_);
    tops_end_ = std::max(end, tops_end_);
}

void WheelInStock::place(const Eigen::Vector2d& xy, double radius, double lowest)
{
    rows_.clear();
    touch_ = kNoMaterial;
    const Eigen::Vector2d at = (xy - stock_.origin) / stock_.cell; // in cells; centres at i + 1/2
    const double half = width_ / 2 / stock_.cell;
    const auto bounded = [](double cell, Eigen::Index count) {
        return Eigen::Index(std::clamp(cell, 0.0, double(count)));
    };
    const Eigen::Index first = bounded(std::ceil(at.x() - half - 0.5 - kFaceToleranceCells), stock_.columns());
    const Eigen::Index end = bounded(std::ceil(at.x() + half - 0.5 - kFaceToleranceCells), stock_.columns());
    if (first != first_column_ || end - first != columns_) {
        first_column_ = first;
        columns_ = end - first;
        tops_first_ = tops_end_ = 0;
    }
    const double max_rise = std::min(max_height_ - lowest, radius); // the rim above this height meets nothing
    if (columns_ == 0 || !(max_rise > 0)) return;

    const double curvature = 1 / radius;
    const double reach = std::sqrt(max_rise * (2 * radius - max_rise)) / stock_.cell;
    const Eigen::Index row_first = bounded(std::ceil(at.y() - reach - 0.5), stock_.rows());
    const Eigen::Index row_end = bounded(std::floor(at.y() + reach - 0.5) + 1, stock_.rows());
    update_row_tops(row_first, row_end);
    const std::ptrdiff_t count = rows_above(row_tops_.data(), row_first, row_end, at.y(), stock_.cell, curvature,
                                            lowest, candidate_rows_.data());
    for (std::ptrdiff_t n = 0; n < count; ++n) { // the parabola is a lower bound of the rim
        const Eigen::Index j = candidate_rows_[n];
        double& top = row_tops_[j];
        const double y = (j + 0.5 - at.y()) * stock_.cell;
        const double level = std::sqrt(std::max(radius * radius - y * y, 0.0));
        const double profile = y * y / (radius + level);
        if (!(top - profile > lowest)) continue;
        touch_ = std::max(touch_, top - profile);
        const double sine = y / radius, cosine = level / radius; // of the slope
        // A rim that is dragged into a wall carries no vertical force there; it does not pull the head down.
        const double lift = rim_.along_normal ? std::max(cosine + rim_.tangential * sine, 0.0) : 1;
        const double push = rim_.along_normal ? rim_.tangential * cosine - sine : 0;
        rows_.push_back({&stock_.z(first_column_, j), &top, profile, lift, push});
    }
}

WheelInStock::Overlap WheelInStock::overlap(double z_tip) const
{
    const WeightedOverlap sums = overlap_of_rows(rows_, columns_, z_tip);
    const double cell_area = stock_.cell * stock_.cell;
    return {sums.height * cell_area, sums.lift * cell_area, sums.area * cell_area, sums.push * cell_area};
}

void WheelInStock::cut(double z_tip) { cut_rows(rows_, columns_, z_tip); }

} // namespace fettle::removal
