#include "core/error.h"
#include "diff/diff.h"

#include <gtest/gtest.h>

#include <limits>

namespace fettle {
namespace diff_test {

std::string points(const std::string& fields, const std::string& types, const std::string& row)
{
    return "FIELDS x y z " + fields + "\nSIZE 4 4 4 4\nTYPE F F F " + types +
           "\nWIDTH 1\nHEIGHT 1\nPOINTS 1\nDATA ascii\n" + row + "\n";
}

diff::Difference of(const std::string& a, const std::string& b, const diff::Tolerance& tolerance = {})
{
    return diff::compare_contents(a, "a", b, "b", tolerance);
}

// The bounds themselves are within; both parts of the tolerance add up.
TEST(Diff, Tolerance)
{
    const std::string a = R"({"x": 8})", b = R"({"x": 10})";
    EXPECT_FALSE(of(a, b).equal());
    EXPECT_TRUE(of(a, b, {2, 0}).equal());
    EXPECT_FALSE(of(a, b, {1.75, 0}).equal());
    EXPECT_TRUE(of(a, b, {0, 0.25}).equal());
    EXPECT_FALSE(of(a, b, {0, 0.125}).equal());
    EXPECT_TRUE(of(a, b, {1, 0.125}).equal());
    EXPECT_EQ(of(a, b, {2, 0}).largest, 2) << "reported although it is within";
}

TEST(Diff, UndefinedNumbers)
{
    const double infinite = std::numeric_limits<double>::infinity();
    const std::string nan = points("a", "F", "1 2 3 nan"), one = points("a", "F", "1 2 3 1"),
                      inf = points("a", "F", "1 2 3 inf"), less = points("a", "F", "1 2 3 -inf");
    EXPECT_TRUE(of(nan, nan).equal());
    EXPECT_TRUE(of(inf, inf).equal());
    for (const std::string& other : {one, inf}) EXPECT_FALSE(of(nan, other, {infinite, 0}).equal());
    EXPECT_FALSE(of(inf, one, {infinite, 1}).equal());
    EXPECT_FALSE(of(inf, less, {infinite, 1}).equal());
}

// Types do not matter, numbers do; colours are compared as colours, in any field type.
TEST(Diff, TypesAndColours)
{
    EXPECT_TRUE(of(points("a", "F", "1 2 3 7"), points("a", "U", "1 2 3 7")).equal());
    EXPECT_FALSE(of(points("a", "F", "1 2 3 7"), points("b", "F", "1 2 3 7")).equal());
    const std::string as_float = points("rgb", "F", "1 2 3 1.4e-45"), as_number = points("rgb", "U", "1 2 3 1");
    EXPECT_TRUE(of(as_float, as_number).equal());
    EXPECT_FALSE(of(as_float, points("rgb", "U", "1 2 3 2")).equal());
}

TEST(Diff, UnreadableIsNotDifferent)
{
    EXPECT_THROW(of("{\"a\": 1}", "{\"a\": 1"), core::InputError);
    EXPECT_THROW(of("{\"a\": 1}", ""), core::InputError);
    EXPECT_THROW(of("{\"a\": 1}", "solid"), core::InputError);
    EXPECT_FALSE(of("{\"a\": 1}", points("a", "F", "1 2 3 7")).equal());
}

} // namespace diff_test
} // namespace fettle
