#pragma once

// The anomalies of find-case: their shapes and draws, and the places on a height map where they stand.

#include "core/constants.h"
#include "find/view.h"
#include "geometry/uniform_draws.h"
#include "part/profile.h"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

namespace find_case {

using namespace fettle;
using Eigen::Index, Eigen::Vector2d, Eigen::Vector3d;
using find::Image, find::Mask;
using std::numbers::pi;

using Random = std::mt19937_64;

inline double draw_between(Random& random, double low, double high)
{
    return low + (high - low) * geometry::draw_uniform(random);
}

inline double draw_log(Random& random, double low, double high)
{
    return std::exp(draw_between(random, std::log(low), std::log(high)));
}

enum class Kind { bead, burr, dot, ring, stub, blob, hill };
constexpr int kKinds = 7;

// Heights that are truth: less is the foot of a hill, which no scan shows. mm
constexpr double kMinTruthHeight = 0.05;

struct Placed {
    part::Anomaly anomaly;
    Vector2d centre; // mm
    double reach;    // of its foot from there, mm
};

inline Eigen::Matrix2Xd turned(const Eigen::Matrix2Xd& points, const Vector2d& centre, double angle)
{
    // As a matrix: the product of Eigen's rotation itself with a matrix of any width has two columns.
    return (Eigen::Rotation2Dd(angle).toRotationMatrix() * points).colwise() + centre;
}

/// A path along x with `corners` corners, `length` long, each off it by a normal deviate.
inline Eigen::Matrix2Xd wavy_path(Random& random, int corners, double length, double deviation)
{
    Eigen::Matrix2Xd path(2, corners);
    for (int k = 0; k < corners; ++k)
        path.col(k) << length * (double(k) / (corners - 1) - 0.5), geometry::draw_normal(random, deviation);
    return path;
}

inline Eigen::Matrix2Xd irregular_outline(Random& random, double radius)
{
    constexpr int kCorners = 9;
    Eigen::Matrix2Xd outline(2, kCorners);
    for (int k = 0; k < kCorners; ++k) {
        const double turn = 2 * pi * k / kCorners + draw_between(random, -0.2, 0.2);
        outline.col(k) = radius * draw_between(random, 0.65, 1.35) * Vector2d(std::cos(turn), std::sin(turn));
    }
    return outline;
}

inline Eigen::Matrix2Xd ellipse(double a, double b)
{
    constexpr int kCorners = 64;
    Eigen::Matrix2Xd outline(2, kCorners);
    for (int k = 0; k < kCorners; ++k) {
        const double turn = 2 * pi * k / kCorners;
        outline.col(k) << a * std::cos(turn), b * std::sin(turn);
    }
    return outline;
}

/// Draft of walls, rad: so steep that a crest or a top of some width remains.
inline double draft(Random& random, double low, double high, double width, double height)
{
    return std::min(core::kRadPerDegree * draw_between(random, low, high), std::atan(0.4 * width / height));
}

/// An anomaly of a kind about a place. @param width  across it, mm
inline Placed make_anomaly(Kind kind, const Vector2d& centre, double width, double height, Random& random)
{
    const double angle = draw_between(random, 0, 2 * pi);
    const part::Roughness rough{draw_between(random, 0.05, 0.35), width * draw_between(random, 0.3, 0.8), random()};
    const double half = width / 2;
    switch (kind) {
    case Kind::bead: {
        const double length = width * draw_between(random, 1.5, 4);
        const auto path = turned(wavy_path(random, 5, length, 0.12 * width), centre, angle);
        return {part::roughened(part::ridge_along(path, {width, height, true, 0}), rough), centre, length / 2 + half};
    }
    case Kind::burr: {
        const double length = width * draw_between(random, 2, 5);
        const auto path = turned(wavy_path(random, 4, length, 0.15 * width), centre, angle);
        const part::RidgeSection section{width, height, false, draft(random, 3, 45, width, height)};
        return {part::roughened(part::ridge_along(path, section), rough), centre, length / 2 + half};
    }
    case Kind::dot:
        return {part::dot(centre, half, std::min(height, 0.45 * width)), centre, half};
    case Kind::ring: {
        const double radius = width * draw_between(random, 1.1, 1.8);
        return {part::ring(centre, radius, {width, height, true, 0}), centre, radius + half};
    }
    case Kind::stub: {
        const part::SlopedTop top{height, height * draw_between(random, 1, 1.4), angle};
        const auto outline = turned(ellipse(1.3 * half, half), centre, angle);
        return {part::stub(outline, top, draft(random, 2, 60, width, top.high)), centre, 1.3 * half};
    }
    case Kind::blob: {
        const auto outline = turned(irregular_outline(random, half), centre, angle);
        return {part::roughened(part::blob(outline, height, width * draw_between(random, 0.1, 0.35)), rough), centre,
                1.35 * half};
    }
    case Kind::hill:
        break;
    }
    return {part::hill(centre, {0.8 * width, 0.55 * width}, angle, height), centre, 0.8 * width};
}

constexpr int kMaxTries = 400;
constexpr double kMaxSmoothSlope = 1; // of places where anomalies stand
// Sizes, in cells and mm.
constexpr double kMinWidthCells = 6, kMinWidth = 3, kMaxWidth = 40;
constexpr double kMaxExtentCells = 25, kMinMaxExtent = 60;
constexpr double kMinHeightSigmas = 8, kMinHeight = 0.3, kMaxHeight = 6;
constexpr double kFaintSigmas = 3, kFaintHeight = 0.2, kFaintSpread = 4; // the last over the first two

/// Which anomalies a case has.
struct Draws {
    bool at_edge, faint;
};

struct Ground {
    find::HeightMap map;
    double sigma; // of the scan to be, mm
    Image room;   // distance of each cell to the nearest that is steep or not seen, mm
};

inline Ground ground_of(const find::HeightMap& map, double sigma)
{
    const Image z = find::filled(find::smoothed(map.z, map.seen, 1.5));
    Mask good = find::closed(map.seen, 1);
    for (int y = 0; y < z.rows; ++y)
        for (int x = 0; x < z.cols; ++x) {
            const float dx = z(y, std::min(x + 1, z.cols - 1)) - z(y, std::max(x - 1, 0));
            const float dy = z(std::min(y + 1, z.rows - 1), x) - z(std::max(y - 1, 0), x);
            if (std::hypot(dx, dy) / (2 * map.cell) >= kMaxSmoothSlope) good(y, x) = 0;
        }
    good = find::dilated(find::eroded(good, 2), 2);
    return {map, sigma, find::depth_of(good) * map.cell};
}

/// Cells where an anomaly of a reach may have its centre.
inline std::vector<cv::Point> places_for(const Ground& ground, Kind kind, double reach, bool at_edge,
                                         const std::vector<Placed>& others)
{
    const double cell = ground.map.cell;
    const bool is_round = kind == Kind::dot || kind == Kind::hill || kind == Kind::blob;
    const double low = !at_edge ? reach + 3 * cell : (is_round ? 0.9 : 0.55) * reach;
    const double high = !at_edge ? core::kInfinity : (is_round ? 1.25 : 1) * reach;
    std::vector<cv::Point> places;
    for (int y = 0; y < ground.room.rows; ++y)
        for (int x = 0; x < ground.room.cols; ++x) {
            if (!(ground.room(y, x) > low && ground.room(y, x) < high)) continue;
            const Vector2d p = ground.map.point_at(x, y);
            if (std::ranges::all_of(others, [&](const Placed& other) {
                    const double both = other.reach + reach;
                    return (other.centre - p).norm() > both + std::max(6 * cell, 0.3 * both);
                }))
                places.emplace_back(x, y);
        }
    return places;
}

inline std::vector<Placed> place_anomalies(const Ground& ground, int number, int count, const Draws& draws,
                                           Random& random)
{
    const double cell = ground.map.cell;
    double room = 0;
    cv::minMaxLoc(ground.room, nullptr, &room);
    const double min_width = std::max(kMinWidth, kMinWidthCells * cell);
    const double max_width = std::max(1.3 * min_width, std::min(kMaxWidth, room * (cell < 2 ? 0.9 : 1.5)));
    const double min_height = draws.faint ? std::max(kFaintHeight, kFaintSigmas * ground.sigma)
                                          : std::max(kMinHeight, kMinHeightSigmas * ground.sigma);
    const double high = draws.faint ? kFaintSpread * min_height : kMaxHeight;
    std::vector<Placed> placed;
    for (int attempt = 0; attempt < count * kMaxTries && int(placed.size()) < count; ++attempt) {
        double width = draw_log(random, min_width, max_width);
        const double max_height = std::max(1.2 * min_height, std::min(high, 0.5 * width));
        const double height = draw_log(random, min_height, max_height);
        const auto kind = Kind((number * 3 + int(placed.size()) * 2 + int(geometry::draw_index(random, 2))) % kKinds);
        if (kind == Kind::ring) width = std::max(0.8 * min_width, 0.45 * width);
        const std::uint64_t form = random();
        Random own(form);
        const double reach = make_anomaly(kind, {0, 0}, width, std::min(height, 0.5 * width), own).reach;
        if (2 * reach > std::max(kMinMaxExtent, kMaxExtentCells * cell)) continue;
        const std::vector<cv::Point> places = places_for(ground, kind, reach, draws.at_edge, placed);
        if (places.size() < 10) continue;
        const cv::Point place = places[geometry::draw_index(random, places.size())];
        own.seed(form);
        placed.push_back(
            make_anomaly(kind, ground.map.point_at(place.x, place.y), width, std::min(height, 0.5 * width), own));
    }
    return placed;
}

/// Number and height of the anomaly at a place; 0 where none is.
inline std::pair<int, double> truth_at(const std::vector<Placed>& placed, const Vector2d& p)
{
    std::pair<int, double> best{0, 0};
    double highest = kMinTruthHeight;
    for (std::size_t k = 0; k < placed.size(); ++k)
        if (const double h = placed[k].anomaly.height(p); h > highest) {
            highest = h;
            best = {int(k) + 1, h};
        }
    return best;
}

} // namespace find_case
