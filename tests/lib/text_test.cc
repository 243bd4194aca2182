#include "core/error.h"
#include "core/lines.h"
#include "core/range.h"
#include "core/text.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>

namespace fettle {
namespace text_test {

TEST(Text, NumbersReadBackToTheSame)
{
    std::mt19937_64 random(1);
    for (int i = 0; i < 20000; ++i) {
        const std::uint64_t bits = random();
        double value;
        std::memcpy(&value, &bits, sizeof value);
        if (std::isnan(value)) continue;
        EXPECT_EQ(core::parse_number(core::to_text(value)), value);
        const float single = static_cast<float>(value);
        EXPECT_EQ(static_cast<float>(*core::parse_number(core::to_text(single))), single);
    }
    EXPECT_EQ(core::to_text(0.1), "0.1");
    EXPECT_EQ(core::to_text(0.1f), "0.1");
    EXPECT_EQ(core::to_text(-std::nan("")), "nan");
    EXPECT_EQ(core::to_text(-std::numeric_limits<double>::infinity()), "-inf");
}

TEST(Text, NumbersAndNothingElse)
{
    for (const char* good : {"1", "-1", "+1", "1.", ".5", "1e3", "1E-3", "inf", "-inf", "nan", "NaN", "5e-324"})
        EXPECT_TRUE(core::parse_number(good)) << good;
    for (const char* bad : {"", "+", "-", "++1", "+-1", "1,5", "1 ", " 1", "0x10", "1e", "1e400", "1d3", "one", "1f"})
        EXPECT_FALSE(core::parse_number(bad)) << bad;
    EXPECT_TRUE(std::isnan(*core::parse_number("nan")));
}

TEST(Text, NearestWord)
{
    const std::vector<std::string> words = {"tolerance", "threads", "seed"};
    EXPECT_EQ(core::nearest_word("tolerence", words), "tolerance");
    EXPECT_EQ(core::nearest_word("thread", words), "threads");
    EXPECT_EQ(core::nearest_word("zzz", words), "");
    EXPECT_EQ(core::nearest_word("", words), "");
    EXPECT_EQ(core::nearest_word("anything", {}), "");
}

TEST(Lines, EndsAndNumbers)
{
    core::Lines lines("one\r\n\ntwo\rthree\nlast");
    std::vector<std::string> found;
    while (lines.next()) found.emplace_back(lines.line());
    EXPECT_EQ(found, (std::vector<std::string>{"one", "", "two\rthree", "last"}));
    EXPECT_EQ(lines.location(), "line 4");
    EXPECT_FALSE(core::Lines("").next());
}

TEST(Lines, WordsAndQuotations)
{
    EXPECT_EQ(core::words(" a\t bc  d "), (std::vector<std::string_view>{"a", "bc", "d"}));
    EXPECT_TRUE(core::words(" \t").empty());
    EXPECT_EQ(core::in_quotes("a\nb\x7f"), "'a?b?'");
    EXPECT_EQ(core::in_quotes(std::string(100, 'x')), "'" + std::string(40, 'x') + "...'");
}

TEST(Lines, MarksOfEncodings)
{
    EXPECT_EQ(core::strip_byte_order_mark("\xef\xbb\xbfx", "file"), "x");
    EXPECT_THROW(core::strip_byte_order_mark("\xff\xfex", "file"), core::InputError);
    EXPECT_THROW(core::strip_byte_order_mark("\xfe\xffx", "file"), core::InputError);
}

TEST(Range, ContainsWhatItSays)
{
    EXPECT_EQ(core::Range().text(), "finite");
    EXPECT_EQ(core::Range::positive().text(), "positive");
    EXPECT_EQ(core::Range::at_least(-2).text(), "at least -2");
    EXPECT_EQ(core::Range::between(0, 1).text(), "in [0, 1]");
    EXPECT_EQ(core::Range::strictly_between(0, 1).text(), "in (0, 1)");
    const double nan = std::nan(""), infinite = std::numeric_limits<double>::infinity();
    for (const core::Range& range :
         {core::Range(), core::Range::positive(), core::Range::at_least(0), core::Range::between(0, 1)}) {
        EXPECT_FALSE(range.contains(nan));
        EXPECT_FALSE(range.contains(infinite));
        EXPECT_FALSE(range.contains(-infinite));
    }
    EXPECT_FALSE(core::Range::positive().contains(0));
    EXPECT_TRUE(core::Range::at_least(0).contains(0));
    EXPECT_FALSE(core::Range::strictly_between(0, 1).contains(1));
}

} // namespace text_test
} // namespace fettle
