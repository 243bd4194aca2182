// The page's parts: escaping, checksums, encodings and numbers against known answers.
#include "core/digest.h"
#include "draw/base64.h"
#include "draw/figures.h"
#include "draw/html.h"
#include "draw/svg.h"
#include "draw/svg_sheet.h"
#include "report/charts.h"

#include <gtest/gtest.h>

#include <limits>

namespace fettle {
namespace report_test {

TEST(Html, TextIsNeverMarkup)
{
    EXPECT_EQ(draw::Html("<b>&\"'").bytes(), "&lt;b&gt;&amp;&quot;&#39;");
    EXPECT_EQ(draw::element("p", {{"title", "\" onclick=\"x"}}, "a<b").bytes(),
              "<p title=\"&quot; onclick=&quot;x\">a&lt;b</p>");
    EXPECT_EQ((draw::element("i", "1") + "<").bytes(), "<i>1</i>&lt;");
    EXPECT_EQ(draw::symbol_with_subscript("F_max").bytes(), "F<sub>max</sub>");
}

// Table 3-7 of Unicode: overlong forms, surrogates, beyond U+10FFFF, cut off.
TEST(Html, WhatIsNoUtf8IsReplaced)
{
    const std::string r = "\uFFFD";
    EXPECT_EQ(draw::Html("\u00E4\u20AC\U0001F600").bytes(), "\u00E4\u20AC\U0001F600");
    EXPECT_EQ(draw::Html("\xC0\xAF").bytes(), r + r);
    EXPECT_EQ(draw::Html("\xE0\x80\xAF").bytes(), r + r + r);
    EXPECT_EQ(draw::Html("\xED\xA0\x80").bytes(), r + r + r);
    EXPECT_EQ(draw::Html("\xF4\x90\x80\x80").bytes(), r + r + r + r);
    EXPECT_EQ(draw::Html("a\xE2\x82").bytes(), "a" + r + r);
    EXPECT_EQ(draw::Html("\u202Ex\u2066\x1B\x7F\u0085").bytes(), r + "x" + r + r + r + r);
    EXPECT_EQ(draw::Html("a\n\tb").bytes(), "a\n\tb");
}

// FIPS 180-4's examples.
TEST(Checksum, IsSha256)
{
    EXPECT_EQ(core::sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
    EXPECT_EQ(core::sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

// RFC 4648, section 10.
TEST(Base64, IsThatOfTheRfc)
{
    EXPECT_EQ(draw::base64(""), "");
    EXPECT_EQ(draw::base64("f"), "Zg==");
    EXPECT_EQ(draw::base64("fo"), "Zm8=");
    EXPECT_EQ(draw::base64("foo"), "Zm9v");
    EXPECT_EQ(draw::base64("foobar"), "Zm9vYmFy");
    EXPECT_EQ(draw::base64("\xFF\xFE\xFD"), "//79");
}

TEST(Figures, HaveThreeDigitsThatMatter)
{
    EXPECT_EQ(draw::short_text(0), "0");
    EXPECT_EQ(draw::short_text(-0.0), "0");
    EXPECT_EQ(draw::short_text(2.5), "2.5");
    EXPECT_EQ(draw::short_text(-0.012345), "\u22120.0123");
    EXPECT_EQ(draw::short_text(1234.5), "1234"); // half to even, as printf rounds
    EXPECT_EQ(draw::short_text(1e-9), "1.00e-09");
    EXPECT_EQ(draw::short_text(std::numeric_limits<double>::quiet_NaN()), "\u2013");
    EXPECT_EQ(draw::fixed_text(-0.0004, 3), "0.000"); // no minus before 0
    EXPECT_EQ(draw::fixed_text(-0.0006, 3), "\u22120.001");
    EXPECT_EQ(draw::decimals_for(0.209), 3);
    EXPECT_EQ(draw::decimals_for(12), 1);
    EXPECT_EQ(draw::decimals_for(0), 2);
    EXPECT_EQ(draw::count_text(1234567), "1\u202F234\u202F567");
    EXPECT_EQ(draw::count_text(123), "123");
}

TEST(Figures, DurationsCarryOver)
{
    EXPECT_EQ(draw::duration_text(12.54), "12.5 s");
    EXPECT_EQ(draw::duration_text(270.8), "4 min 31 s");
    EXPECT_EQ(draw::duration_text(119.7), "2 min 00 s");
    EXPECT_EQ(draw::duration_text(7260), "2 h 01 min");
}

// Widths as in Helvetica's metrics: m is 833, e, a and n 556 thousandths; with room for a font that is 16 % wider, as
// DejaVu Sans.
TEST(SvgSheet, KnowsHowWideTextIs)
{
    const draw::SvgSheet sheet(100, 100);
    EXPECT_NEAR(sheet.text_width("mean", 7.18), 1.16 * (833 + 3 * 556) / 100, 1e-12);
    EXPECT_NEAR(sheet.text_width("\u00E4", 7.18), 1.16 * 5.56, 1e-12);
}

TEST(SvgSheet, DrawsTextPicturesAndSigns)
{
    draw::SvgSheet sheet(100, 50);
    sheet.text("-1 a-b <", {10, 20}, 7.18, {1, 2, 3});
    const std::vector<std::uint8_t> pixels = {255, 0, 0, 0, 0, 255};
    sheet.image({1, 2}, {20, 10}, 2, pixels);
    const std::string html = sheet.drawing("a map").bytes();
    EXPECT_NE(html.find(">\u22121 a-b &lt;</text>"), std::string::npos) << html;
    EXPECT_NE(html.find("fill:#010203"), std::string::npos);
    EXPECT_NE(html.find("<image x=\"1\" y=\"2\" width=\"20\" height=\"10\""), std::string::npos);
    EXPECT_NE(html.find("viewBox=\"0 0 100 50\""), std::string::npos);
}

TEST(Svg, TicksAreRoundAndInside)
{
    const draw::svg::Axis axis = {0, 1, 100, 200};
    EXPECT_DOUBLE_EQ(axis(0.25), 125);
    const std::string html = draw::svg::ticks_below(axis, 0, 50, 5).bytes();
    for (const char* tick : {">0.0<", ">0.2<", ">0.8<", ">1.0<"}) EXPECT_NE(html.find(tick), std::string::npos) << tick;
    EXPECT_EQ(html.find(">1.2<"), std::string::npos);
    EXPECT_EQ(draw::svg::coordinate(12.5), "12.5");
    EXPECT_EQ(draw::svg::coordinate(-0.001), "0");
    EXPECT_EQ(
        draw::svg::text({0, 0}, "F_max 15").bytes(),
        "<text x=\"0\" y=\"0\" text-anchor=\"start\">F<tspan dy=\"3\">max</tspan><tspan dy=\"-3\" class=\"line\"> "
        "15</tspan></text>\n"); // copied, each text is a line
}

// A reader of the chart has to see how fast the feed is: its axis has a label beside 0, whatever the largest feed.
TEST(TraceChart, LabelsTheFeedAboveZero)
{
    cloud::Cloud trace;
    trace.xyz = Eigen::Matrix3Xd::Zero(3, 2);
    cloud::set_field(trace, "t", Eigen::Vector2d(1, 2));
    for (const char* name : {"force", "layer", "event"}) cloud::set_field(trace, name, Eigen::Vector2d(1, 1));
    for (double feed = 1; feed < 11; feed *= 1.07) {
        cloud::set_field(trace, "feed", Eigen::Vector2d(0, feed));
        const std::string chart = report::trace_chart(trace, std::nullopt, units::Units{}).bytes();
        // The labels of an axis come before the name of its panel.
        const std::size_t begin = chart.find(">layer<"), end = chart.find(">feed, ");
        ASSERT_TRUE(begin < end && end != std::string::npos);
        int labels = 0;
        for (std::size_t at = begin; (at = chart.find("text-anchor=\"end\"", at + 1)) < end;) ++labels;
        EXPECT_GE(labels, 2) << feed;
        EXPECT_LE(labels, 4) << feed; // more would overlap
    }
}

} // namespace report_test
} // namespace fettle
