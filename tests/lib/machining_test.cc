// Cutters and what they leave of a stock, against closed forms, brute force and identities.

#include "core/error.h"
#include "machining/cutter.h"
#include "machining/cutter_path.h"
#include "machining/milling.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <vector>

using namespace fettle;

namespace machining_test {

constexpr double kNoContact = std::numeric_limits<double>::infinity();
constexpr double kPi = std::numbers::pi;
/// The bound of every closed form, mm.
constexpr double kExact = 1e-9;

removal::HeightField block(double half, double top, double cell)
{
    const Eigen::AlignedBox2d box(Eigen::Vector2d(-half, -half), Eigen::Vector2d(half, half));
    removal::HeightField field = removal::empty_height_field(box, {0, 0}, 0, cell);
    field.z.setConstant(top);
    return field;
}

machining::CutterMove line(const Eigen::Vector3d& from, const Eigen::Vector3d& to)
{
    machining::CutterMove move;
    move.from = from;
    move.to = to;
    move.feed = 10;
    return move;
}

machining::CutterMove arc(const Eigen::Vector2d& centre, double radius, double begin, double sweep, double z)
{
    const auto at = [&](double angle) {
        return Eigen::Vector3d(centre.x() + radius * std::cos(angle), centre.y() + radius * std::sin(angle), z);
    };
    machining::CutterMove move = line(at(begin), at(begin + sweep));
    move.sweep_angle = sweep;
    move.centre = centre;
    return move;
}

/// Greatest difference of the cut stock from a formula of x, y.
template <typename Formula>
double error_of(const removal::HeightField& stock, double top, const Formula& height)
{
    double max = 0;
    for (Eigen::Index j = 0; j < stock.rows(); ++j)
        for (Eigen::Index i = 0; i < stock.columns(); ++i) {
            const double expected = std::min(top, height(stock.centre(i, j)));
            const double off = std::abs(stock.z(i, j) - expected);
            max = std::max(max, std::isnan(off) ? kNoContact : off);
        }
    return max;
}

double ball_height(double r, double distance)
{
    return distance <= r ? r - std::sqrt((r - distance) * (r + distance)) : kNoContact;
}

double to_segment(const Eigen::Vector2d& p, const Eigen::Vector2d& a, const Eigen::Vector2d& b)
{
    const double t = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
    return (p - a - t * (b - a)).norm();
}

TEST(Cutter, IsReadAsItIsWritten)
{
    const machining::Cutter ball = machining::parse_cutter("ball:12"), flat = machining::parse_cutter("flat:8"),
                            bull = machining::parse_cutter("bull:10,2");
    EXPECT_EQ(ball.radius, 6);
    EXPECT_EQ(machining::rise(ball, 6), 6);
    EXPECT_EQ(machining::rise(flat, 4), 0);
    EXPECT_EQ(machining::rise(flat, 4.0001), kNoContact);
    EXPECT_EQ(machining::rise(bull, 3), 0);
    EXPECT_EQ(machining::rise(bull, 5), 2);
    EXPECT_NEAR(machining::rise(bull, 4.2), 2 - 1.6, 1e-15); // 3-4-5: 1.2 out, 1.6 up
    const machining::Cutter taper = machining::parse_cutter("taper:10,30,1");
    EXPECT_NEAR(taper.cone_from, std::cos(kPi / 6), 1e-15);
    EXPECT_NEAR(machining::rise(taper, taper.cone_from), 1 - 0.5, 1e-15);
    EXPECT_NEAR(machining::rise(taper, 5), 0.5 + (5 - taper.cone_from) * std::sqrt(3.0), 1e-14);
    EXPECT_NEAR(machining::rise(machining::parse_cutter("taper:10,45,0"), 3), 3, 1e-15);
    for (const char* wrong :
         {"ball", "ball:", "ball:0", "ball:-1", "ball:nan", "ball:1,2", "bull:10", "bull:10,6", "bull:10,-1",
          "taper:10,0,1", "taper:10,90,1", "taper:10,30", "taper:2,10,3", "drill:3", "flat:inf", ""})
        EXPECT_THROW(machining::parse_cutter(wrong), core::InputError) << wrong;
}

TEST(Cutter, TipOfAContactTouchesThere)
{
    // The plane through the contact with that normal touches the lower side in it, and is nowhere above it.
    for (const char* name : {"ball:12", "flat:8", "bull:10,2", "taper:10,30,1"}) {
        const machining::Cutter cutter = machining::parse_cutter(name);
        for (const double tilt : {0.0, 0.3, 1.0, 1.04}) {
            const Eigen::Vector3d normal(std::sin(tilt) * 0.6, std::sin(tilt) * 0.8, std::cos(tilt));
            const Eigen::Vector3d contact(1, 2, 3), tip = machining::tip_at_contact(cutter, contact, normal);
            const Eigen::Vector3d from_tip = contact - tip;
            EXPECT_NEAR(machining::rise(cutter, from_tip.head<2>().norm() * (1 - 1e-12)), from_tip.z(), 1e-9)
                << name << tilt;
            for (double d = 0; d <= cutter.radius; d += cutter.radius / 64)
                for (double a = 0; a < 2 * kPi; a += 0.1)
                    EXPECT_GT(
                        (tip + Eigen::Vector3d(d * std::cos(a), d * std::sin(a), machining::rise(cutter, d)) - contact)
                            .dot(normal),
                        -1e-9);
        }
    }
    EXPECT_THROW(machining::tip_at_contact(machining::parse_cutter("ball:12"), {0, 0, 0}, {0, 0.6, -0.8}),
                 core::InputError);
    EXPECT_THROW(
        machining::tip_at_contact(machining::parse_cutter("taper:10,30,1"), {0, 0, 0}, {0.9, 0, std::sqrt(0.19)}),
        core::InputError);
}

TEST(Milling, BallAlongALine)
{
    const double r = 3, top = 50;
    for (const double slope : {0.0, 0.4, -1.7}) {
        removal::HeightField stock = block(10, top, 0.23);
        const Eigen::Vector3d a(-4.1, -2.3, 1), b(4.4, 3.1, 1 + slope * std::hypot(8.5, 5.4));
        machining::mill(stock, machining::parse_cutter("ball:6"), {line(a, b)});
        // The lower side of a cylinder along the move and of a ball at either end.
        const Eigen::Vector3d direction = (b - a).normalized();
        const double error = error_of(stock, top, [&](const Eigen::Vector2d& p) {
            double z = std::min(a.z() + ball_height(r, (p - a.head<2>()).norm()),
                                b.z() + ball_height(r, (p - b.head<2>()).norm()));
            const Eigen::Vector2d u = (b - a).head<2>().normalized(), q = p - a.head<2>();
            const double across = u.x() * q.y() - u.y() * q.x();
            if (std::abs(across) > r) return z;
            // where the cylinder's lower generator of this offset is touched: normal to the move
            const double rho = std::sqrt((r - across) * (r + across));
            const double axis = q.dot(u) - rho * direction.z(); // level distance of the axis: the normal leans back
            if (axis < 0 || axis > (b - a).head<2>().norm()) return z;
            return std::min(z, a.z() + r + slope * axis - rho * direction.head<2>().norm());
        });
        EXPECT_LE(error, kExact) << slope;
    }
}

TEST(Milling, BallAlongAnArc)
{
    const double r = 2, R = 5, top = 50;
    for (const double sweep : {1.0, -2.5, 4.0, -5.9, 2 * kPi}) {
        removal::HeightField stock = block(10, top, 0.21);
        machining::mill(stock, machining::parse_cutter("ball:4"), {arc({0.3, -0.2}, R, 0.4, sweep, 1)});
        const double error = error_of(stock, top, [&](const Eigen::Vector2d& p) {
            const Eigen::Vector2d q = p - Eigen::Vector2d(0.3, -0.2);
            double past = std::atan2(q.y(), q.x()) - 0.4; // counted in the arc's sense
            if (sweep < 0) past = -past;
            while (past < 0) past += 2 * kPi;
            const auto end = [&](double angle) {
                return (q - R * Eigen::Vector2d(std::cos(angle), std::sin(angle))).norm();
            };
            const double distance =
                past <= std::abs(sweep) ? std::abs(q.norm() - R) : std::min(end(0.4), end(0.4 + sweep));
            return 1 + ball_height(r, distance);
        });
        EXPECT_LE(error, kExact) << sweep;
    }
}

TEST(Milling, BallAroundACorner)
{
    const double top = 50;
    for (const double angle : {0.05, 1.2, 2.9}) {
        removal::HeightField stock = block(10, top, 0.19);
        const Eigen::Vector3d a(-6, 0.1, 1), b(0.5, 0.1, 1),
            c = b + 5 * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0);
        machining::mill(stock, machining::parse_cutter("ball:5"), {line(a, b), line(b, c)});
        const double error = error_of(stock, top, [&](const Eigen::Vector2d& p) {
            return 1 + ball_height(2.5, std::min(to_segment(p, a.head<2>(), b.head<2>()),
                                                 to_segment(p, b.head<2>(), c.head<2>())));
        });
        EXPECT_LE(error, kExact) << angle;
    }
}

const std::vector<std::string> kCutters = {"ball:3",     "flat:3",         "bull:3,0.5",
                                           "bull:3,1.4", "taper:3,20,0.4", "taper:3,50,0"};

/// A run of moves as controls send them: straight, level, plunges, sharp turns, arcs; short ones and long ones.
std::vector<machining::CutterMove> random_moves(unsigned seed, int count)
{
    std::mt19937 random(seed);
    const auto within = [&](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    };
    std::vector<machining::CutterMove> moves;
    Eigen::Vector3d at(within(-4, 4), within(-4, 4), within(1, 3));
    double heading = within(0, 6);
    while (static_cast<int>(moves.size()) < count) {
        const int kind = static_cast<int>(within(0, 10));
        heading += kind < 3 ? within(-3, 3) : within(-0.2, 0.2);
        const double far = kind < 6 ? within(0.02, 0.4) : within(0.5, 3);
        Eigen::Vector3d to = at + far * Eigen::Vector3d(std::cos(heading), std::sin(heading), 0);
        if (kind % 2 == 0) to.z() += far * within(-2, 2);
        if (kind == 7) to = at + Eigen::Vector3d(0, 0, within(-1, 1));
        to = to.cwiseMax(Eigen::Vector3d(-5, -5, 0.5)).cwiseMin(Eigen::Vector3d(5, 5, 4));
        if (kind == 9) {
            const double radius = within(0.2, 4), begin = within(-3, 3), sweep = within(-6, 6);
            const Eigen::Vector2d centre = at.head<2>() - radius * Eigen::Vector2d(std::cos(begin), std::sin(begin));
            moves.push_back(arc(centre, radius, begin, sweep, at.z()));
        } else {
            moves.push_back(line(at, to));
        }
        at = moves.back().to;
    }
    return moves;
}

/// Position of the tip at a share of the move.
Eigen::Vector3d tip(const machining::CutterMove& move, double share)
{
    if (move.sweep_angle == 0) return move.from + share * (move.to - move.from);
    const Eigen::Vector2d start = move.from.head<2>() - move.centre;
    const double c = std::cos(share * move.sweep_angle), s = std::sin(share * move.sweep_angle);
    Eigen::Vector3d at = move.from;
    at.head<2>() = move.centre + Eigen::Vector2d(c * start.x() - s * start.y(), s * start.x() + c * start.y());
    return at;
}

/// The minimum height of a convex cutter over p on a straight move, by a golden section search.
double min_height(const machining::Cutter& cutter, const machining::CutterMove& move, const Eigen::Vector2d& p)
{
    // the part of the move from which the cutter reaches p
    const Eigen::Vector2d along = (move.to - move.from).head<2>(), off = p - move.from.head<2>();
    const double squared = along.squaredNorm();
    double first = 0, last = 1;
    if (squared > 0) {
        const double middle = off.dot(along) / squared, beside = (off - middle * along).squaredNorm();
        if (beside > cutter.radius * cutter.radius) return kNoContact;
        const double half = std::sqrt((cutter.radius * cutter.radius - beside) / squared);
        first = std::max(first, middle - half);
        last = std::min(last, middle + half);
        if (first > last) return kNoContact;
    } else if (off.norm() > cutter.radius) {
        return kNoContact;
    }
    const auto height = [&](double share) {
        const Eigen::Vector3d at = tip(move, share);
        return at.z() + machining::rise(cutter, std::min((p - at.head<2>()).norm(), cutter.radius));
    };
    double min = std::min(height(first), height(last));
    for (int i = 0; i < 120; ++i) {
        const double a = first + (last - first) / 3, b = last - (last - first) / 3;
        const double at_a = height(a), at_b = height(b);
        min = std::min({min, at_a, at_b});
        if (at_a <= at_b) last = b;
        if (at_a >= at_b) first = a;
    }
    return min;
}

TEST(Milling, EveryCutterAgainstAMinimumByBruteForce)
{
    for (const std::string& name : kCutters)
        for (unsigned seed = 1; seed <= 3; ++seed) {
            const machining::Cutter cutter = machining::parse_cutter(name);
            std::vector<machining::CutterMove> moves = random_moves(seed, 60);
            std::erase_if(moves, [](const machining::CutterMove& move) { return move.sweep_angle != 0; });
            for (std::size_t m = 1; m < moves.size(); ++m) moves[m].from = moves[m - 1].to; // over the arcs' gaps
            removal::HeightField stock = block(7, 50, 0.37);
            machining::mill(stock, cutter, moves);
            const double error = error_of(stock, 50, [&](const Eigen::Vector2d& p) {
                double z = kNoContact;
                for (const machining::CutterMove& move : moves) z = std::min(z, min_height(cutter, move, p));
                return z;
            });
            EXPECT_LE(error, kExact) << name << " seed " << seed;
        }
}

TEST(Milling, StampsComeDownToTheSweep)
{
    // Stamps at positions along the moves leave more material than the sweep, and the finer the less, by the square
    // of their distance: a cutter's height changes with the square near its minimum. (On slopes, the rim of a flat one
    // and a sharp tip change evenly.)
    for (const std::string& name : kCutters) {
        const machining::Cutter cutter = machining::parse_cutter(name);
        const std::vector<machining::CutterMove> moves = random_moves(7, 40);
        removal::HeightField swept = block(7, 50, 0.37);
        machining::mill(swept, cutter, moves);
        const auto excess = [&](double spacing) {
            double sum = 0;
            std::vector<Eigen::Vector3d> tips;
            for (const machining::CutterMove& move : moves) {
                const int steps = static_cast<int>(std::ceil(machining::length(move) / spacing));
                for (int k = 0; k <= steps; ++k)
                    tips.push_back(tip(move, steps == 0 ? 0 : static_cast<double>(k) / steps));
            }
            for (Eigen::Index j = 0; j < swept.rows(); ++j)
                for (Eigen::Index i = 0; i < swept.columns(); ++i) {
                    double z = 50;
                    for (const Eigen::Vector3d& at : tips) {
                        const double distance = (swept.centre(i, j) - at.head<2>()).norm();
                        if (distance < cutter.radius) z = std::min(z, at.z() + machining::rise(cutter, distance));
                    }
                    EXPECT_GE(z, swept.z(i, j) - kExact) << name;
                    // the very rim, which stamps reach late, is left out
                    if (z < 49) sum += z - swept.z(i, j);
                }
            return sum;
        };
        const double coarse = excess(0.08), fine = excess(0.02);
        EXPECT_LT(fine, coarse / 3) << name;
        EXPECT_GT(coarse, 0) << name;
    }
}

TEST(Milling, VolumesAddUpToTheRemovedStock)
{
    for (const std::string& name : kCutters) {
        removal::HeightField stock = block(7, 3.5, 0.11);
        const removal::HeightField before = stock;
        double volume = 0;
        for (const machining::MoveEngagement& bite :
             machining::mill(stock, machining::parse_cutter(name), random_moves(3, 80)))
            volume += bite.volume;
        EXPECT_GT(volume, 10);
        EXPECT_NEAR(volume, removal::volume_between(before, stock), 1e-10 * volume) << name;
    }
}

TEST(Milling, VolumesOfASlotAndAPlunge)
{
    const double cell = 0.02;
    removal::HeightField slot = block(6, 2, cell);
    const double cut =
        machining::mill(slot, machining::parse_cutter("flat:3"), {line({-3, 0, 1}, {3, 0, 1})})[0].volume;
    EXPECT_NEAR(cut, 6 * 3 + kPi * 1.5 * 1.5, 2e-3 * cut); // of the order of the rim's cells
    removal::HeightField dimple = block(6, 2, cell);
    const double h = 0.8, r = 1.5;
    const double cap =
        machining::mill(dimple, machining::parse_cutter("ball:3"), {line({0.003, 0.007, 3}, {0.003, 0.007, 2 - h})})[0]
            .volume;
    EXPECT_NEAR(cap, kPi * h * h * (3 * r - h) / 3, 1e-4 * cap);
}

TEST(Milling, ThreadsChangeNothing)
{
    const auto moves = random_moves(5, 300);
    const auto cut = [&](std::size_t threads) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        removal::HeightField stock = block(7, 3.5, 0.03);
        const auto bites = machining::mill(stock, machining::parse_cutter("bull:3,0.5"), moves);
        return std::pair(stock, bites);
    };
    const auto one = cut(1), four = cut(4);
    EXPECT_TRUE((one.first.z == four.first.z).all());
    for (std::size_t m = 0; m < moves.size(); ++m) {
        EXPECT_EQ(one.second[m].volume, four.second[m].volume);
        EXPECT_EQ(one.second[m].depth, four.second[m].depth);
    }
}

TEST(Milling, NothingIsLeftBelowTheFloor)
{
    removal::HeightField stock = block(5, 2, 0.1);
    machining::MillingOptions options;
    options.floor = 0;
    const double volume =
        machining::mill(stock, machining::parse_cutter("flat:4"), {line({0, 0, 5}, {0, 0, -1})}, options)[0].volume;
    EXPECT_NEAR(volume, 2 * kPi * 4, 0.02 * volume);
    EXPECT_NEAR(static_cast<double>(stock.z.isNaN().count()) * 0.01, kPi * 4, 0.25);
    EXPECT_EQ((stock.z == 2).count() + stock.z.isNaN().count(), stock.z.size());
}

TEST(Milling, RunsOfRapidAndFeedMovesKeepTheirMaterial)
{
    // Down into the block by a rapid, on by feed: the hole belongs to the rapid, the slot to the feed move; back up in
    // the same hole there is nothing left to meet.
    removal::HeightField stock = block(5, 2, 0.05);
    machining::CutterMove down = line({-2, 0, 5}, {-2, 0, 1}), back = line({2, 0, 1}, {2, 0, 5});
    down.feed = back.feed = 0;
    const auto bites =
        machining::mill(stock, machining::parse_cutter("flat:2"), {down, line({-2, 0, 1}, {2, 0, 1}), back});
    EXPECT_NEAR(bites[0].volume, kPi, 0.02);
    EXPECT_NEAR(bites[0].depth, 1, kExact);
    EXPECT_NEAR(bites[1].volume, 4 * 2, 0.05);
    EXPECT_EQ(bites[2].depth, 0);
}

TEST(Milling, HolderMeetsWhatStands)
{
    // A wall 4 mm high, 3 mm beside the cutter's path; the holder of radius 5 is 2.5 mm over the tip, which runs 1 mm
    // above the floor of the pocket: it is 0.5 mm deep in the wall.
    removal::HeightField stock = block(10, 0, 0.1);
    for (Eigen::Index j = 0; j < stock.rows(); ++j)
        for (Eigen::Index i = 0; i < stock.columns(); ++i)
            if (stock.centre(i, j).y() > 3) stock.z(i, j) = 4;
    machining::MillingOptions options;
    options.holder = machining::Holder{5, 2.5};
    const auto run = [&](double y) {
        return machining::mill(stock, machining::parse_cutter("ball:2"), {line({-5, y, 1}, {5, y, 1})}, options)[0];
    };
    EXPECT_EQ(run(-2.1).holder_depth, 0);
    EXPECT_NEAR(run(0).holder_depth, 0.5, kExact);
    EXPECT_EQ(run(0).volume, 0);
}

cloud::Cloud two_points()
{
    cloud::Cloud cloud;
    cloud.xyz.resize(3, 2);
    cloud.xyz << 0, 3, 0, 4, 1, 1;
    return cloud;
}

TEST(CutterPath, GoesThroughThePoints)
{
    cloud::Cloud cloud = two_points();
    const machining::Cutter ball = machining::parse_cutter("ball:4");
    const auto moves = machining::moves_from_points(cloud, ball, false, 7, "path.pcd");
    ASSERT_EQ(moves.size(), 1u);
    EXPECT_EQ(machining::length(moves[0]), 5);
    EXPECT_EQ(moves[0].feed, 7);
    EXPECT_EQ(moves[0].source_line, 2u);
    cloud::set_field(cloud, "feed", Eigen::Vector2d(1, 0));
    EXPECT_TRUE(machining::moves_from_points(cloud, ball, false, 7, "path.pcd")[0].rapid());
    EXPECT_THROW(machining::moves_from_points(cloud, ball, true, 7, "path.pcd"), core::InputError); // no normals
    cloud::set_normals(cloud, Eigen::Vector3d(0.6, 0, 0.8).replicate(1, 2));
    EXPECT_LT(
        (machining::moves_from_points(cloud, ball, true, 7, "")[0].from - Eigen::Vector3d(1.2, 0, 1 + 1.6 - 2)).norm(),
        1e-6);
    cloud::set_field(cloud, "feed", Eigen::Vector2d(1, -1));
    EXPECT_THROW(machining::moves_from_points(cloud, ball, false, 7, "path.pcd"), core::InputError);
    cloud = two_points();
    cloud::set_field(cloud, "qx", Eigen::Vector2d(0, 0.1));
    cloud::set_field(cloud, "qy", Eigen::Vector2d(0, 0));
    EXPECT_THROW(machining::moves_from_points(cloud, ball, false, 7, "path.pcd"), core::InputError);
    cloud = two_points();
    cloud.xyz(1, 1) = std::nan("");
    EXPECT_THROW(machining::moves_from_points(cloud, ball, false, 7, "path.pcd"), core::InputError);
    EXPECT_NEAR(machining::length(arc({0, 0}, 2, 1, -3, 0)), 6, 1e-14);
}

} // namespace machining_test
