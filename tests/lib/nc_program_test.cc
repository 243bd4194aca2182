// The G-code reader: each word with a case, positions against plain geometry, refusals with their line.

#include "core/error.h"
#include "machining/nc_program.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

using namespace fettle;

namespace nc_program_test {

constexpr double kPi = std::numbers::pi;

machining::NcProgram read(const std::string& text) { return machining::parse_nc_program(text, "p.nc"); }

/// The last place of a program that begins at 1, 2, 3 with F600 (10 mm/s).
Eigen::Vector3d end_of(const std::string& text) { return read("G0 X1 Y2 Z3 F600\n" + text).moves.back().to; }

std::string refusal(const std::string& text)
{
    try {
        read(text);
    } catch (const core::InputError& error) {
        return error.what();
    }
    return "";
}

using V = Eigen::Vector3d;

TEST(NcProgram, MotionFeedAndPlaces)
{
    const machining::NcProgram program = read("%\nN10 G21 G90 G17\nG0 X0 Y0 Z5\nG1 Z-1 F300\nx4 y3\n G0 Z5\nM30\n%\n");
    ASSERT_EQ(program.moves.size(), 4u);
    EXPECT_EQ(program.moves[0].to, V(0, 0, 5)); // is where it is first known
    EXPECT_TRUE(program.moves[0].rapid());
    EXPECT_EQ(program.moves[1].feed, 5); // mm/s
    EXPECT_EQ(program.moves[1].source_line, 4u);
    EXPECT_EQ(program.moves[2].to, V(4, 3, -1));
    EXPECT_EQ(program.moves[2].feed, 5); // G1 and F hold
    EXPECT_TRUE(program.moves[3].rapid());
    EXPECT_TRUE(program.unplaced_rapids.empty());
}

TEST(NcProgram, UnitsAndDistances)
{
    EXPECT_EQ(end_of("G20 G1 X2"), V(50.8, 2, 3));
    EXPECT_EQ(end_of("G20 G1 X2\nG21 Y7"), V(50.8, 7, 3));
    EXPECT_NEAR(read("G20\nG0 X0 Y0 Z0\nG1 X1 F60").moves.back().feed, 25.4, 1e-12);
    EXPECT_EQ(end_of("G91 G1 X2 Y-1\nX2\nG90 Z0"), V(5, 1, 0));
    EXPECT_EQ(end_of("G91 G0 Z+2."), V(1, 2, 5));
}

TEST(NcProgram, ArcsByCentreAndByRadius)
{
    // From (1, 2): a quarter, three quarters and a whole turn about (1, 7), in both directions.
    const std::string start = "G0 X1 Y2 Z3 F600\n";
    const auto last = [&](const std::string& line) { return read(start + line).moves.back(); };
    EXPECT_NEAR(last("G3 X6 Y7 I0 J5").sweep_angle, kPi / 2, 1e-12);
    EXPECT_NEAR(last("G2 X6 Y7 J5").sweep_angle, -1.5 * kPi, 1e-12);
    EXPECT_NEAR(last("G2 X-4 Y7 J5").sweep_angle, -kPi / 2, 1e-12);
    EXPECT_NEAR(last("G3 J5").sweep_angle, 2 * kPi, 1e-12);
    EXPECT_NEAR(last("G2 X1 Y2 J5").sweep_angle, -2 * kPi, 1e-12);
    EXPECT_LT((last("G3 X6 Y7 I0 J5").centre - Eigen::Vector2d(1, 7)).norm(), 1e-12);
    EXPECT_LT((last("G3 X6 Y7 R5").centre - Eigen::Vector2d(1, 7)).norm(), 1e-12);
    EXPECT_NEAR(last("G3 X6 Y7 R5").sweep_angle, kPi / 2, 1e-12);
    EXPECT_NEAR(last("G3 X6 Y7 R-5").sweep_angle, 1.5 * kPi, 1e-12);
    EXPECT_LT((last("G3 X6 Y7 R-5").centre - Eigen::Vector2d(6, 2)).norm(), 1e-12);
    EXPECT_LT((last("G2 X6 Y7 R5").centre - Eigen::Vector2d(6, 2)).norm(), 1e-12);
    EXPECT_NEAR(last("G2 X11 Y2 R5").sweep_angle, -kPi, 1e-12);
    EXPECT_NEAR(last("G20 G2 X0.4331 Y0.0787 R0.1969").sweep_angle, -kPi, 0.2); // digits rounded: half a turn, nearly
    // The digits of the end put it 4e-5 mm off: a round arc to that end.
    const machining::CutterMove rounded = last("G3 X6.00004 Y7 J5");
    EXPECT_NEAR((rounded.to.head<2>() - rounded.centre).norm(), (rounded.from.head<2>() - rounded.centre).norm(),
                1e-12);
    EXPECT_NE(rounded.sweep_angle, 0);
}

/// Chords stay within kArcChordTolerance of the curve, begin and end on it, and follow each other.
void expect_on_curve(const std::vector<machining::CutterMove>& moves, const std::function<double(const V&)>& off)
{
    double farthest = 0;
    for (std::size_t m = 0; m < moves.size(); ++m) {
        if (m > 0) {
            EXPECT_EQ(moves[m].from, moves[m - 1].to);
        }
        EXPECT_EQ(moves[m].sweep_angle, 0);
        EXPECT_LT(off(moves[m].to), 1e-9);
        farthest = std::max(farthest, off((moves[m].from + moves[m].to) / 2));
    }
    EXPECT_LT(farthest, machining::kArcChordTolerance * 1.01);
    EXPECT_GT(farthest, machining::kArcChordTolerance / 4); // and no finer than need be
}

TEST(NcProgram, ArcsInOtherPlanesAndHelices)
{
    machining::NcProgram program =
        read("G0 X0 Y0 Z0 F600\nG18 G2 X10 Z10 I10\n"); // about (10, 0): clockwise seen from +Y
    EXPECT_EQ(program.chorded_arcs, 1u);
    program.moves.erase(program.moves.begin());
    EXPECT_EQ(program.moves.back().to, V(10, 0, 10));
    expect_on_curve(program.moves,
                    [](const V& p) { return std::abs(std::hypot(p.x() - 10, p.z()) - 10) + std::abs(p.y()); });
    // Z→X is the positive turn about Y: about (10, 0) the move begins at -90° and ends at 0°, by the longer arc.
    double turn = 0;
    for (const machining::CutterMove& move : program.moves) {
        const auto angle = [](const V& p) { return std::atan2(p.x() - 10, p.z()); };
        turn += std::remainder(angle(move.to) - angle(move.from), 2 * kPi);
    }
    EXPECT_NEAR(turn, -1.5 * kPi, 1e-9);

    program = read("G0 X0 Y0 Z0 F600\nG19 G3 Y10 Z10 J0 K10\n"); // Y→Z about X: from -90° to 0°
    turn = 0;
    for (const machining::CutterMove& move : program.moves) {
        const auto angle = [](const V& p) { return std::atan2(p.z() - 10, p.y()); };
        turn += std::remainder(angle(move.to) - angle(move.from), 2 * kPi);
    }
    EXPECT_NEAR(turn, kPi / 2, 1e-9);

    program = read("G0 X5 Y0 Z0 F600\nG17 G3 X5 Y0 Z-2 I-5\n"); // one turn of a thread
    program.moves.erase(program.moves.begin());
    expect_on_curve(program.moves, [](const V& p) {
        double share = std::atan2(p.y(), p.x()) / (2 * kPi);
        if (share < -1e-9) share += 1;
        const double z = std::min(std::abs(p.z() + 2 * share), std::abs(p.z() + 2)); // at the seam it has come down
        return std::abs(p.head<2>().norm() - 5) + z;
    });
    EXPECT_EQ(program.moves.back().to, V(5, 0, -2));

    program = read("G0 X5 Y0 Z0 F600\nG3 X0 Y5.01 I-5\n"); // ends 0.01 off: a spiral
    EXPECT_EQ(program.chorded_arcs, 1u);
    EXPECT_EQ(program.moves.back().to, V(0, 5.01, 0));
}

TEST(NcProgram, WordsWithoutMotionAreCounted)
{
    const machining::NcProgram program = read(
        "G40 G49 G80 G94 G64 P0.01 (all at once)\nG54\nG55\nG56\nG57\nG58\nG59\nT1 M6\nS8000 M3\nM4\nM5\nM7\nM8\nM9\n"
        "G0 X0 Y0\nG43 H1 Z10\nG1 X1 F100\nG64\nM30\n");
    for (const char* word : {"G40", "G49", "G80", "G94", "G54", "G55", "G56", "G57", "G58", "G59", "G43",
                             "M3",  "M4",  "M5",  "M6",  "M7",  "M8",  "M9",  "M30", "S",   "T"})
        EXPECT_EQ(program.non_motion_words.at(word), 1u) << word;
    EXPECT_EQ(program.non_motion_words.at("G64"), 2u);
    EXPECT_EQ(program.non_motion_words.size(), 22u);
    EXPECT_EQ(program.unplaced_rapids.size(), 1u); // X0 Y0 before any Z
    ASSERT_EQ(program.moves.size(), 2u);
    EXPECT_EQ(program.moves[1].to, V(1, 0, 10));
}

TEST(NcProgram, WordsOfOrdinaryHeadersAndEndsAreAccepted)
{
    const machining::NcProgram program =
        read("G17 G20 G40 G49 G80 G90 G00\nX1 Y0 Z0\nG61\nG61.1\nG64 P0.01 Q0.02\n"
             "G91.1 G97 S100 M48\nG98\nG99 M49\nG4 P1.5\nM0\nM1\nM60\nF10\nG1 X2\nM2\n");
    ASSERT_EQ(program.moves.size(), 2u);
    EXPECT_EQ(program.moves[1].to, V(50.8, 0, 0));
    for (const char* word :
         {"G4", "G61", "G61.1", "G64", "G80", "G91.1", "G97", "G98", "G99", "M0", "M1", "M2", "M48", "M49", "M60"})
        EXPECT_EQ(program.non_motion_words.at(word), 1u) << word;
    EXPECT_EQ(end_of("G1 G80 X4\nX5"), V(5, 2, 3)); // G80 beside a motion: the motion holds
    EXPECT_NE(refusal("G0 X0 Y0 Z0\nG80\nX1").find("line 3: coordinates without a motion mode"), std::string::npos);
}

// Reference: rs274 prints SET_FEED_RATE before USE_LENGTH_UNITS for "G20 F10 G1 X1".
TEST(NcProgram, FeedBesideAChangeOfUnitIsRefused)
{
    EXPECT_NE(refusal("G0 X0 Y0 Z0\nG20 G1 X1 F10").find("line 2: F on a line that changes the unit"),
              std::string::npos);
    EXPECT_NE(refusal("G20\nG0 X0 Y0 Z0\nG21 F10\nG1 X1").find("line 3: F on a line"), std::string::npos);
    EXPECT_EQ(read("G21 F60\nG0 X0 Y0 Z0\nG21 G1 X1 F120").moves.back().feed, 2); // the unit stays
    // A change of the unit alone leaves the feed as it is.
    EXPECT_EQ(read("G0 X0 Y0 Z0 F120\nG20\nG1 X1").moves.back().feed, 2);
}

TEST(NcProgram, MovesWithDifferentOffsetsAreRefused)
{
    const std::string start = "G54 G0 X0 Y0 Z9 F100\n";
    EXPECT_NE(refusal(start + "G55 G1 X1").find("line 2: a move with the coordinate system G55 after moves with G54"),
              std::string::npos);
    EXPECT_NE(refusal("G0 X0 Y0\nG59 Z0").find("coordinate system G59 after moves with G54"), std::string::npos);
    EXPECT_NE(
        refusal(start + "G43 H1\nX1").find("line 3: a move with the tool length offset G43 H1 after moves with G49"),
        std::string::npos);
    EXPECT_NE(refusal("G0 X0 Y0\nG43 H1 Z5\nG43 H2 Z6").find("G43 H2 after moves with G43 H1"), std::string::npos);
    EXPECT_NE(refusal("T1 M6 G43\nG0 X0 Y0 Z1\nT2 M6\nG43\nX1").find("G43 for tool 2 after moves with G43 for tool 1"),
              std::string::npos);
    // Without a move after it, at a Z that is not known yet, and repeated, an offset does not matter.
    EXPECT_EQ(read("G55 G0 X0 Y0\nG43 H1 Z5\nG43 H1 X1\nG55 X2\nG49\nG54\nM30").moves.back().to, V(2, 0, 5));
    EXPECT_EQ(read("T1 M6\nG43\nG0 X0 Y0 Z1\nG43\nX1").moves.back().to, V(1, 0, 1));
}

TEST(NcProgram, BeginsWhereItIsTold)
{
    const machining::NcProgram program = machining::parse_nc_program("(x)\nG91 G1 X1 F60\nG90 Z2", "p.nc", V(1, 2, 3));
    ASSERT_EQ(program.moves.size(), 3u);
    EXPECT_EQ(program.moves[0].from, V(1, 2, 3));
    EXPECT_EQ(program.moves[0].to, V(1, 2, 3));
    EXPECT_TRUE(program.moves[0].rapid());
    EXPECT_EQ(program.moves[0].source_line, 2u);
    EXPECT_EQ(program.moves[1].to, V(2, 2, 3));
    EXPECT_EQ(program.moves[2].to, V(2, 2, 2));
    EXPECT_NE(refusal("G1 X1 F60").find("--start"), std::string::npos);
}

TEST(NcProgram, ChangesOfTheToolAfterCutsAreNoted)
{
    EXPECT_EQ(read("T1 M6\nG0 X0 Y0 Z0 F60\nG1 X1\nT2\nM6\nG1 X2").tool_change, 5u);
    EXPECT_EQ(read("T1 M6\nG0 X0 Y0 Z0 F60\nT2 M6\nG1 X1").tool_change, 0u);
}

TEST(NcProgram, ExpressionsAndOWordsAreNamed)
{
    EXPECT_EQ(
        refusal("G0 X[1+2] Y3"),
        "p.nc: line 1: expected a number after X, got '[1+2]': parameters (#) and expressions ([ ]) are not read");
    EXPECT_EQ(refusal("#1=3"),
              "p.nc: line 1: expected a word, got '#1=3': parameters (#) and expressions ([ ]) are not read");
    EXPECT_EQ(refusal("o<cut> sub"), "p.nc: line 1: O-words (subprograms, loops) are not read, got 'O<CUT>'");
    EXPECT_EQ(refusal("G0 X"), "p.nc: line 1: expected a number after X, got nothing");
}

TEST(NcProgram, CommentsBlanksAndCase)
{
    EXPECT_EQ(end_of("n5(a)g 1x 4 (b) y-.5;G0 Z100"), V(4, -0.5, 3));
    EXPECT_EQ(end_of("\n  \r\n(only this)\n; and this\nG1 X4\r\n"), V(4, 2, 3));
    EXPECT_EQ(end_of("G01 X+4. Y02"), V(4, 2, 3));
}

TEST(NcProgram, RefusesTheRestWithItsLine)
{
    const std::string start = "G0 X0 Y0 Z0\n";
    for (const char* line : {"G4",
                             "G4 X1",
                             "G4 P1 X1",
                             "G5 X1",
                             "G10 L2",
                             "G28",
                             "G41 D1",
                             "G42",
                             "G53 X0",
                             "G59.1",
                             "G61.2",
                             "G64 G61",
                             "G73",
                             "G81 X1",
                             "G92 X0",
                             "G93",
                             "G95",
                             "G96",
                             "G90.1",
                             "M10",
                             "M98",
                             "M3.5",
                             "O100",
                             "A10",
                             "B10",
                             "C10",
                             "D1",
                             "E1",
                             "L1",
                             "Q1",
                             "U1",
                             "#1=5",
                             "X[1+2]",
                             "X#1",
                             "o<loop> while",
                             "X#<place>",
                             "/G1 X1",
                             "X",
                             "X--1",
                             "X1.2.3",
                             "X1e3",
                             "X1,5",
                             "G",
                             "(never closed",
                             "(a (b) c)",
                             "G1 G0 X1",
                             "G17 G18",
                             "G20 G21",
                             "G90 G91",
                             "G54 G55",
                             "X1 X2",
                             "H1",
                             "P1",
                             "F0",
                             "F-1",
                             "N1.5",
                             "N-1",
                             "X1e999",
                             "X99999999",
                             "% G1",
                             "G1 X1",
                             "\xff"})
        EXPECT_EQ(refusal(start + "G1 F100\n" + (std::string(line) == "G1 X1" ? "G80 X1" : line)).substr(0, 12),
                  "p.nc: line 3")
            << line;
    for (const char* line : {"G1 X1", "G2 X1 I0.5"}) // no F
        EXPECT_NE(refusal(start + line).find("line 2: a feed move, but no F yet"), std::string::npos) << line;
    for (const char* line : {"G2 X10 I4", "G2 X10", "G2 X10 R4", "G2 X10 R5 I5", "G2 R5", "G2 X10 I5 K1",
                             "G18 G2 X10 I5 J1", "G1 X1 I1", "G0 X1 R1", "G2 X0 I0 J0", "G2 X10 R0"})
        EXPECT_EQ(refusal(start + "F100\n" + line).substr(0, 12), "p.nc: line 3") << line;
    EXPECT_NE(refusal("G1 X1 Y1 Z1 F1").find("line 1: a feed move, but X is not known yet"), std::string::npos);
    EXPECT_NE(refusal("G0 X0 Y0\nG1 X1 F100").find("Z is not known"), std::string::npos);
    EXPECT_NE(refusal("G91 G0 X1").find("relative (G91)"), std::string::npos);
    EXPECT_NE(refusal("X1 Y1").find("none of G0"), std::string::npos);
    EXPECT_NE(refusal(start + "G0 X1\nM30\nG0 X2").find("line 4: after the end"), std::string::npos);
    EXPECT_NE(refusal(start + "G0 X1\nM2\nG0 X2").find("line 4: after the end"), std::string::npos);
    EXPECT_NE(refusal("%\n" + start + "X1\n%\nX2").find("line 5: after the closing %"), std::string::npos);
    EXPECT_NE(refusal(start + "F100\nG18 G2 I90990").find("line 3: an arc with a radius of 90990 mm"),
              std::string::npos);
    EXPECT_NE(refusal(start + "F100\nG18 G2 I1e300").find("line 3"), std::string::npos);
    EXPECT_NE(refusal("").find("has no moves"), std::string::npos);
    EXPECT_NE(refusal("G0 X0 Y0 Z0\n").find("has no moves"), std::string::npos);
    EXPECT_NE(refusal("\xff\xfeG").find("UTF-16"), std::string::npos);
}

TEST(NcProgram, IsDistinguishedFromPoints)
{
    for (const char* text : {"%\n", "(x)\n", "; x\n", "N10 G0", "\n  g0 x1\n", "\xef\xbb\xbfG0"})
        EXPECT_TRUE(machining::looks_like_nc_program(text)) << text;
    for (const char* text : {"#1=3\n", "#<depth> = 2\n", "o<cut> sub\n", "O100 sub\n", "/G0 X1\n", "X[1+2]\n"})
        EXPECT_TRUE(machining::looks_like_nc_program(text)) << text;
    for (const char* text :
         {"#1 2 3\n", "# a = b\n", "#1 mm = 3\n", "//X Y Z\n", "#\n", "#<a\n", "/\n", "# .PCD v0.7\n1=1"})
        EXPECT_FALSE(machining::looks_like_nc_program(text)) << text;
    for (const char* text : {"", "# .PCD v0.7\n", "VERSION 0.7\n", "1 2 3\n", "ply\n", "x y z\n", "FIELDS x y z\n"})
        EXPECT_FALSE(machining::looks_like_nc_program(text)) << text;
}

} // namespace nc_program_test
