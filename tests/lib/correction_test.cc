// Corrected paths: on planes exact, programs rewritten with the same moves, and what cannot be corrected.

#include "machining/correction.h"

#include "cloud/cloud.h"
#include "height_surface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>
#include <string>

using namespace fettle;

namespace correction_test {

const Eigen::Vector3d kNormal(-0.6, 0, 0.8);

/// z = 3/4 x, lifted along its normal.
mesh::Mesh slope(double half, int cells, double lift)
{
    return height_surface(-half, half, cells, [&](double x, double) { return 0.75 * x + lift / kNormal.z(); });
}

/// Moves of a tip whose cutter touches the slope, lifted, at places given by x and y.
std::vector<machining::CutterMove> moves_on(const machining::Cutter& cutter, double lift,
                                            const std::vector<Eigen::Vector2d>& places)
{
    std::vector<machining::CutterMove> moves;
    Eigen::Vector3d at = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < places.size(); ++i) {
        const Eigen::Vector3d contact(places[i].x(), places[i].y(), 0.75 * places[i].x());
        const Eigen::Vector3d tip = machining::tip_at_contact(cutter, contact, kNormal) + lift * kNormal;
        machining::CutterMove move;
        move.from = at;
        move.to = at = tip;
        move.feed = 5;
        move.source_line = i + 1;
        if (i > 0) moves.push_back(move);
    }
    return moves;
}

TEST(Correction, TakesAnOffsetOfAPlaneBack)
{
    const mesh::Mesh design = slope(30, 3, 0);
    for (const char* name : {"ball:6", "flat:6", "bull:6,1", "taper:6,30,1"})
        for (const double lift : {0.07, -0.07}) {
            const machining::Cutter cutter = machining::parse_cutter(name);
            const auto moves = moves_on(cutter, lift, {{-8, -3}, {2, 5}, {9, -7}});
            const mesh::Mesh machined = slope(20, 40, lift);
            const auto path =
                machining::correct(moves, cutter, machined, design, machining::patch_errors(machined, design), 0.01);
            ASSERT_EQ(path.moves.size(), 2u) << name; // corrected moves are straight again
            const auto right = moves_on(cutter, 0, {{-8, -3}, {2, 5}, {9, -7}});
            for (std::size_t m = 0; m < 2; ++m) {
                EXPECT_LT((path.moves[m].from - right[m].from).norm(), 1e-9) << name << ' ' << lift;
                EXPECT_LT((path.moves[m].to - right[m].to).norm(), 1e-9);
                EXPECT_EQ(path.moves[m].source_line, moves[m].source_line);
            }
            EXPECT_NEAR(path.max_shift, 0.07, 1e-9);
            EXPECT_EQ(path.unknown + path.in_air + path.blocked, 0u);
        }
}

TEST(Correction, LeavesWhatIsInTheAirAndNeverDigs)
{
    const machining::Cutter cutter = machining::parse_cutter("ball:6");
    const mesh::Mesh design = slope(30, 3, 0), machined = slope(20, 40, 0.07);
    const auto roughing = moves_on(cutter, 1, {{-8, -3}, {2, 5}}); // what is under it was cut deeper
    auto path = machining::correct(roughing, cutter, machined, design, machining::patch_errors(machined, design), 0.01);
    ASSERT_EQ(path.moves.size(), 1u);
    EXPECT_EQ(path.moves[0].to, roughing[0].to);
    EXPECT_EQ(path.shifted, 0u);
    EXPECT_GT(path.in_air, 10u);
    // Material that the cutter did not leave (its tips are right): there is nothing to go down for.
    const auto right = moves_on(cutter, 0, {{-8, -3}, {2, 5}});
    path = machining::correct(right, cutter, machined, design, machining::patch_errors(machined, design), 0.01);
    EXPECT_LT((path.moves.back().to - right[0].to).head<2>().norm(), 0.05);
    EXPECT_GT(path.blocked, 10u);
    for (const machining::CutterMove& move : path.moves) {
        const Eigen::Vector3d centre = move.to + Eigen::Vector3d(0, 0, 3);
        EXPECT_GE(centre.dot(kNormal), 3 - 1e-9);
    }
}

TEST(Correction, TipsOfUnknownErrorGoAsTheirNeighbours)
{
    const machining::Cutter cutter = machining::parse_cutter("ball:6");
    const mesh::Mesh design = slope(30, 3, 0), machined = slope(5, 10, -0.07); // smaller than the path
    const auto moves = moves_on(cutter, -0.07, {{-9, 0}, {0, 0}, {9, 0}});
    const auto path =
        machining::correct(moves, cutter, machined, design, machining::patch_errors(machined, design), 0.01);
    EXPECT_GT(path.unknown, 5u);
    EXPECT_LT((path.moves.back().to - moves_on(cutter, 0, {{0, 0}, {9, 0}})[0].to).norm(), 1e-9);
}

// On a level plane an arc is led on the arc, only deeper, as finely as its chords ask.
TEST(Correction, FollowsAnArc)
{
    const machining::Cutter cutter = machining::parse_cutter("ball:6");
    const auto level = [](double half, int cells, double z) {
        return height_surface(-half, half, cells, [z](double, double) { return z; });
    };
    const mesh::Mesh design = level(30, 3, 0), machined = level(20, 4, 0.07); // facets of 10 mm
    machining::CutterMove arc;
    arc.from = {8, 0, 0.07};
    arc.to = {0, 8, 0.07};
    arc.centre = {0, 0};
    arc.sweep_angle = std::numbers::pi / 2;
    arc.feed = 5;
    const auto path =
        machining::correct({arc}, cutter, machined, design, machining::patch_errors(machined, design), 0.01);
    ASSERT_GT(path.moves.size(), 8u);
    EXPECT_LT((path.moves.front().from - Eigen::Vector3d(8, 0, 0)).norm(), 1e-9);
    EXPECT_LT((path.moves.back().to - Eigen::Vector3d(0, 8, 0)).norm(), 1e-9);
    for (const machining::CutterMove& move : path.moves) {
        EXPECT_NEAR(move.to.head<2>().norm(), 8, 1e-9);
        EXPECT_NEAR(((move.from + move.to) / 2).head<2>().norm(), 8, 0.02);
        EXPECT_NEAR(move.to.z(), 0, 1e-9);
    }
}

TEST(Correction, StraightUpStaysStraightUp)
{
    const machining::Cutter cutter = machining::parse_cutter("ball:6");
    const mesh::Mesh design = slope(30, 3, 0), machined = slope(20, 40, 0.5);
    auto moves = moves_on(cutter, 0.5, {{-8, -3}, {2, 5}});
    machining::CutterMove plunge = moves[0], lift = moves[0];
    plunge.to = moves[0].from;
    plunge.from = plunge.to + Eigen::Vector3d(0, 0, 30);
    lift.from = moves[0].to;
    lift.to = lift.from + Eigen::Vector3d(0, 0, 30);
    lift.feed = 0;
    moves = {plunge, moves[0], lift};
    const auto path =
        machining::correct(moves, cutter, machined, design, machining::patch_errors(machined, design), 0.01);
    ASSERT_EQ(path.moves.size(), 3u);
    for (const std::size_t m : {0u, 2u}) {
        EXPECT_EQ(path.moves[m].from.head<2>(), path.moves[m].to.head<2>());
        EXPECT_GT((path.moves[m].to - moves[m].to).head<2>().norm(), 0.1);
    }
    EXPECT_EQ(path.moves[0].from.z(), plunge.from.z());
    EXPECT_EQ(path.moves[2].to.z(), lift.to.z());
}

TEST(Correction, KeepsWhatAProgramSaysBesideItsMoves)
{
    const std::string text =
        "%\n(part 7) \nN10 G20 G91 T2 M6\n\nN20 S8000 M3 ; on\nG90 G43 H2 G0 Z1\nX0 Y0\n"
        "G1 G64 P0.01 Z0.1 F10 (down)\nX1\nG2 X2 Y1 R1\nG3 Y0 J-0.5 M8\ng18 g2 x3 z.1 i.5\nG80\nG0 Z1 M30\n%\n";
    machining::ToolPath path = machining::parse_tool_path(text, "p.nc", machining::parse_cutter("ball:6"));
    machining::CorrectedPath same;
    same.moves = path.program.moves;
    std::ostringstream out;
    machining::write_corrected(out, path, same);
    const machining::ToolPath again =
        machining::parse_tool_path(out.str(), "again.nc", machining::parse_cutter("ball:6"));
    for (const char* kept : {"(part 7)", "T2 M6", "; on", "G43 H2", "G64 P0.01", "(down)", "M8", "G80", "G20"})
        EXPECT_NE(out.str().find(kept), std::string::npos) << kept << " in\n" << out.str();
    EXPECT_EQ(path.program.non_motion_words, again.program.non_motion_words);
    ASSERT_EQ(path.program.moves.size(), again.program.moves.size()) << out.str();
    EXPECT_EQ(path.program.unplaced_rapids.size(), again.program.unplaced_rapids.size());
    for (std::size_t m = 0; m < path.program.moves.size(); ++m) {
        const machining::CutterMove &a = path.program.moves[m], &b = again.program.moves[m];
        EXPECT_LT((a.to - b.to).norm(), 1e-5) << m;
        EXPECT_NEAR(a.sweep_angle, b.sweep_angle, 1e-6);
        EXPECT_NEAR(a.feed, b.feed, 1e-9);
        if (a.sweep_angle != 0) {
            EXPECT_LT((a.centre - b.centre).norm(), 1e-5);
        }
    }
}

TEST(Correction, KeepsTheFieldsOfPoints)
{
    const std::string text = "x y z tool\n-8 -3 -6 4\n2 5 1.5 5\n9 -7 6.75 6\n";
    const machining::Cutter cutter = machining::parse_cutter("ball:6");
    const machining::ToolPath path = machining::parse_tool_path(text, "p.xyz", cutter, {false, 7});
    machining::CorrectedPath split; // the first move in two
    split.moves = {path.program.moves[0], path.program.moves[0], path.program.moves[1]};
    split.moves[0].to = split.moves[1].from = Eigen::Vector3d(1, 2, 3);
    const cloud::Cloud cloud = machining::corrected_points(path, split, false);
    EXPECT_EQ(cloud::field(cloud, "tool"), Eigen::Vector4d(4, 5, 5, 6));
    EXPECT_EQ(cloud::field(cloud, "feed"), Eigen::Vector4d(0, 7, 7, 7));
    EXPECT_EQ(cloud.xyz.col(1), Eigen::Vector3d(1, 2, 3));
    EXPECT_FALSE(cloud::has_field(machining::corrected_points(path, split, true), "tool"));
}

} // namespace correction_test
