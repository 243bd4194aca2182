#include "machining/refinement.h"

#include "core/constants.h"
#include "machining/milling.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fettle::machining {
namespace {

/// Side of a tile, the unit that is cut again on a fine grid, in squares.
constexpr Eigen::Index kTileSquares = 16;
const double kRefinedSlope = std::tan(kRefinedSlopeDegrees * std::numbers::pi / 180);

/// The empty fine grid of a tile; every `factor`-th of its centres is that of a cell of the coarse grid.
removal::HeightField empty_tile(const removal::HeightField& map, Eigen::Index i, Eigen::Index j, int factor)
{
    removal::HeightField tile;
    tile.theta = map.theta;
    tile.cell = map.cell / factor;
    tile.origin = map.centre(i, j).array() - tile.cell / 2;
    const Eigen::Index side = kTileSquares * factor + 1;
    tile.z = Eigen::ArrayXXd::Constant(side, side, core::kNaN);
    return tile;
}

} // namespace

Refinement::Refinement(const Workpiece& piece, const removal::HeightField& machined, const Cutter& cutter,
                       const std::vector<CutterMove>& moves, int factor)
    : machined_(machined), factor_(factor), columns_(machined.columns() - 1), rows_(machined.rows() - 1),
      tile_columns_(std::max<Eigen::Index>(columns_, 0) / kTileSquares + 1)
{
    if (columns_ < 1 || rows_ < 1) return;
    refined_.assign(columns_ * rows_, 0);
    tile_.assign(tile_columns_ * (rows_ / kTileSquares + 1), -1);
    // A neighbour of a square with an empty corner is not refined: that square is one triangle, which cannot take more
    // vertices.
    const auto rise_of = [&](Eigen::Index i, Eigen::Index j) { // NaN: an empty corner; 0: outside the grid
        if (i < 0 || j < 0 || i >= columns_ || j >= rows_) return 0.0;
        const Eigen::Array22d z = machined.z.block<2, 2>(i, j);
        return z.sum() * 0 + z.maxCoeff() - z.minCoeff();
    };
    for (Eigen::Index j = 0; j < rows_; ++j)
        for (Eigen::Index i = 0; i < columns_; ++i) {
            if (!(rise_of(i, j) > kRefinedSlope * machined.cell)) continue;
            if (std::isnan(rise_of(i - 1, j) + rise_of(i + 1, j) + rise_of(i, j - 1) + rise_of(i, j + 1))) continue;
            refined_[j * columns_ + i] = 1;
            std::int32_t& tile = tile_[j / kTileSquares * tile_columns_ + i / kTileSquares];
            if (tile >= 0) continue;
            tile = static_cast<std::int32_t>(fields_.size());
            const Eigen::Index first_i = i / kTileSquares * kTileSquares, first_j = j / kTileSquares * kTileSquares;
            fields_.push_back(empty_tile(machined, first_i, first_j, factor));
            piece.rasterize(fields_.back());
        }
    mill_fields(fields_, cutter, moves, piece.floor);
    // Heights on the common border of two tiles must be bitwise equal.
    const Eigen::Index last = kTileSquares * factor_;
    const std::size_t columns = tile_columns_;
    for (std::size_t t = 0; t < tile_.size(); ++t) {
        if (tile_[t] < 0) continue;
        removal::HeightField& field = fields_[tile_[t]];
        if (t % columns > 0 && tile_[t - 1] >= 0) field.z.row(0) = fields_[tile_[t - 1]].z.row(last);
        if (t >= columns && tile_[t - columns] >= 0) field.z.col(0) = fields_[tile_[t - columns]].z.col(last);
    }
}

bool Refinement::is_refined(Eigen::Index i, Eigen::Index j) const
{
    if (i < 0 || j < 0 || i >= columns_ || j >= rows_) return false;
    return refined_[j * columns_ + i] != 0;
}

std::size_t Refinement::count() const { return std::ranges::count(refined_, 1); }

Eigen::Vector3d Refinement::point(Eigen::Index i, Eigen::Index j, int a, int b) const
{
    const auto between = [&](Eigen::Index cell, int part) {
        return static_cast<double>(cell * factor_ + part) / factor_ + 0.5; // exact: factor_ is a power of two
    };
    const Eigen::Vector2d xy = machined_.origin + machined_.cell * Eigen::Vector2d(between(i, a), between(j, b));
    if (a % factor_ == 0 && b % factor_ == 0) return {xy.x(), xy.y(), machined_.z(i + a / factor_, j + b / factor_)};
    const removal::HeightField& field = fields_[tile_[j / kTileSquares * tile_columns_ + i / kTileSquares]];
    return {xy.x(), xy.y(), field.z(i % kTileSquares * factor_ + a, j % kTileSquares * factor_ + b)};
}

} // namespace fettle::machining
