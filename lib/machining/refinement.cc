#include "machining/refinement.h"

#include "machining/milling.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace fettle {
namespace {

/// Squares along a side of what is cut again at a time.
constexpr Eigen::Index kTile = 16;
const double kSteepest = std::tan(kSteepSquare * std::numbers::pi / 180);

/// The finer map over a tile: the centres of its cells lie on those of the map's and between them.
HeightField tile_at(const HeightField& map, Eigen::Index i, Eigen::Index j, int factor)
{
    HeightField tile;
    tile.theta = map.theta;
    tile.cell = map.cell / factor;
    tile.origin = map.centre(i, j).array() - tile.cell / 2;
    const Eigen::Index side = kTile * factor + 1;
    tile.z = Eigen::ArrayXXd::Constant(side, side, std::numeric_limits<double>::quiet_NaN());
    return tile;
}

} // namespace

Refinement::Refinement(const Workpiece& piece, const HeightField& machined, const Cutter& cutter,
                       const std::vector<CutterMove>& moves, int factor)
    : machined_(machined), factor_(factor), columns_(machined.columns() - 1), rows_(machined.rows() - 1),
      tiles_across_(std::max<Eigen::Index>(columns_, 0) / kTile + 1)
{
    if (columns_ < 1 || rows_ < 1) return;
    refined_.assign(static_cast<std::size_t>(columns_ * rows_), 0);
    tile_.assign(static_cast<std::size_t>(tiles_across_ * (rows_ / kTile + 1)), -1);
    // a square next to one that lacks a corner stays: that one's triangle has no place for more corners
    const auto rise_of = [&](Eigen::Index i, Eigen::Index j) { // NaN: it lacks a corner; 0: beyond the map
        if (i < 0 || j < 0 || i >= columns_ || j >= rows_) return 0.0;
        const Eigen::Array22d z = machined.z.block<2, 2>(i, j);
        return z.sum() * 0 + z.maxCoeff() - z.minCoeff();
    };
    for (Eigen::Index j = 0; j < rows_; ++j)
        for (Eigen::Index i = 0; i < columns_; ++i) {
            if (!(rise_of(i, j) > kSteepest * machined.cell)) continue;
            if (std::isnan(rise_of(i - 1, j) + rise_of(i + 1, j) + rise_of(i, j - 1) + rise_of(i, j + 1))) continue;
            refined_[static_cast<std::size_t>(j * columns_ + i)] = 1;
            std::int32_t& tile = tile_[static_cast<std::size_t>(j / kTile * tiles_across_ + i / kTile)];
            if (tile >= 0) continue;
            tile = static_cast<std::int32_t>(fields_.size());
            fields_.push_back(tile_at(machined, i / kTile * kTile, j / kTile * kTile, factor));
            piece.lay(fields_.back());
        }
    mill_each(fields_, cutter, moves, piece.floor);
    // One height, to the last digit, where tiles meet.
    const Eigen::Index last = kTile * factor_;
    for (std::size_t t = 0; t < tile_.size(); ++t) {
        if (tile_[t] < 0) continue;
        HeightField& field = fields_[static_cast<std::size_t>(tile_[t])];
        const auto across = static_cast<std::size_t>(tiles_across_);
        if (t % across > 0 && tile_[t - 1] >= 0)
            field.z.row(0) = fields_[static_cast<std::size_t>(tile_[t - 1])].z.row(last);
        if (t >= across && tile_[t - across] >= 0)
            field.z.col(0) = fields_[static_cast<std::size_t>(tile_[t - across])].z.col(last);
    }
}

bool Refinement::refined(Eigen::Index i, Eigen::Index j) const
{
    if (i < 0 || j < 0 || i >= columns_ || j >= rows_) return false;
    return refined_[static_cast<std::size_t>(j * columns_ + i)] != 0;
}

std::size_t Refinement::count() const
{
    return static_cast<std::size_t>(std::count(refined_.begin(), refined_.end(), 1));
}

Eigen::Vector3d Refinement::place(Eigen::Index i, Eigen::Index j, int a, int b) const
{
    const auto between = [&](Eigen::Index cell, int part) {
        return static_cast<double>(cell * factor_ + part) / factor_ + 0.5; // exact: factor_ is a power of two
    };
    const Eigen::Vector2d xy = machined_.origin + machined_.cell * Eigen::Vector2d(between(i, a), between(j, b));
    if (a % factor_ == 0 && b % factor_ == 0) return {xy.x(), xy.y(), machined_.z(i + a / factor_, j + b / factor_)};
    const std::int32_t tile = tile_[static_cast<std::size_t>(j / kTile * tiles_across_ + i / kTile)];
    return {xy.x(), xy.y(),
            fields_[static_cast<std::size_t>(tile)].z(i % kTile * factor_ + a, j % kTile * factor_ + b)};
}

} // namespace fettle
