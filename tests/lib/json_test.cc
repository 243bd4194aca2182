#include "core/error.h"
#include "json/document.h"
#include "json/leaves.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <sstream>

namespace fettle::json {
namespace json_test {

using Read = std::function<void(Reader&)>;

std::string message_of(const std::string& text, const Read& read = {})
{
    try {
        Reader reader = Reader::parse(text, "file");
        if (read) read(reader);
    } catch (const core::InputError& error) {
        return error.what();
    }
    return "accepted";
}

void expect_refused(const std::string& text, const std::string& part, const Read& read = {})
{
    const std::string message = message_of(text, read);
    EXPECT_EQ(message.find("file: "), 0u) << text << "\n  " << message;
    EXPECT_NE(message.find(part), std::string::npos) << text << "\n  " << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
}

TEST(Json, WhatIsNoStrictJsonIsRefused)
{
    expect_refused("", "empty");
    expect_refused(" \n", "empty");
    expect_refused("{\"a\": 1", "line 1, column 8");
    expect_refused("{\n\"a\": 1,\n}", "line 3, column 1");
    expect_refused("{\"a\": 1} {\"a\": 1}", "line 1, column 10");
    expect_refused("{\"a\": NaN}", "column 7");
    expect_refused("{\"a\": Infinity}", "column 7");
    expect_refused("{\"a\": 1e999}", "1e999");
    expect_refused("{\"a\": 01}", "column 8");
    expect_refused("{\"a\": 1,5}", "column 9");
    expect_refused("{'a': 1}", "column 2");
    expect_refused("{\"a\": 1 // one\n}", "column 9");
    expect_refused("{\"a\": \"\xff\"}", "UTF-8");
    expect_refused("[1]", "expected a JSON object, got an array");
    expect_refused("7", "expected a JSON object, got a number");
    expect_refused("{\"a\": 1, \"b\": {\"c\": 1, \"c\": 2}}", "key 'c' is duplicated");
    expect_refused("{\"a\": \"b\\u0000c\"}", "'b?c' contains the character U+0000");
    expect_refused("{\"a\\u0000\": 1}", "'a?' contains the character U+0000");
    expect_refused(std::string(100000, '['), "nested deeper than");
    std::string nested;
    for (int i = 0; i < 100000; ++i) nested += "{\"a\":";
    expect_refused(nested, "nested deeper than");
    EXPECT_EQ(message_of("\xef\xbb\xbf{\"a\": 1}"), "accepted") << "a mark of UTF-8 is read over";
    std::string wide = "\xff\xfe{";
    expect_refused(wide, "text in UTF-16, expected JSON");
}

TEST(Json, MembersHaveTypesAndRanges)
{
    const std::string text =
        R"({"kind": "job", "n": 2.5, "i": 3, "t": "word", "f": true, "v": [1, 2], "m": [[1, 2], [3]],
                                 "o": {"x": 1, "z": null}, "l": [{"x": 1}, {"x": "one"}]})";
    Reader good = Reader::parse(text, "file");
    good.expect_kind("job");
    EXPECT_EQ(good.number("n"), 2.5);
    EXPECT_EQ(good.number_or("absent", 7), 7);
    EXPECT_EQ(good.integer("i", 0, 5), 3);
    EXPECT_EQ(good.text("t"), "word");
    EXPECT_TRUE(good.flag_or("f", false));
    EXPECT_EQ(good.vector("v"), Eigen::Vector2d(1, 2));
    EXPECT_TRUE(std::isnan(good.ragged_matrix("m", 1, 2)(1, 1)));
    EXPECT_EQ(good.object("o").number("x"), 1);
    EXPECT_EQ(good.objects("l").size(), 2u);
    good.reject_unknown_keys();

    expect_refused(text, "kind: expected \"plan\", got \"job\"", [](Reader& r) { r.expect_kind("plan"); });
    expect_refused(R"({"kind": "a\nb"})", "kind: expected \"plan\", got \"a?b\"",
                   [](Reader& r) { r.expect_kind("plan"); });
    expect_refused(text, "absent: missing, expected a number", [](Reader& r) { r.number("absent"); });
    expect_refused(text, "t: expected a number, got text", [](Reader& r) { r.number("t"); });
    expect_refused(text, "n: must be in [3, 4], got 2.5", [](Reader& r) { r.number("n", core::Range::between(3, 4)); });
    expect_refused(text, "i: must be in [4, 5], got 3", [](Reader& r) { r.integer("i", 4, 5); });
    expect_refused(text, "n: must be a whole number, got 2.5", [](Reader& r) { r.integer("n", 0, 5); });
    expect_refused(text, "n: expected text, got a number", [](Reader& r) { r.text("n"); });
    expect_refused(text, "n: expected true or false, got a number", [](Reader& r) { r.flag_or("n", true); });
    expect_refused(text, "t: \"word\" is none of sword, shield; did you mean \"sword\"?", [](Reader& r) {
        r.choice("t", {"sword", "shield"});
    });
    expect_refused(text, "v: expected 3 numbers, got 2", [](Reader& r) { r.vector("v", 3); });
    expect_refused(text, "m[0]: expected a number, got an array", [](Reader& r) { r.vector("m"); });
    expect_refused(text, "m[1]: expected 2 numbers, got 1", [](Reader& r) { r.matrix("m", 2); });
    expect_refused(text, "m: rows of different length", [](Reader& r) { r.matrix("m"); });
    expect_refused(text, "v[0]: expected an array of numbers, got a number", [](Reader& r) { r.matrix("v"); });
    expect_refused(text, "o.z: expected a number, got null", [](Reader& r) { r.object("o").number("z"); });
    expect_refused(text, "l[1].x: expected a number, got text", [](Reader& r) { r.objects("l")[1].number("x"); });
    expect_refused(text, "v[0]: expected an object, got a number", [](Reader& r) { r.objects("v"); });
}

TEST(Json, RowsOfTexts)
{
    const std::vector<std::vector<std::string>> rows =
        Reader::parse(R"({"a": [["x", "y"], ["z", ""]]})", "f").text_rows("a", 2);
    EXPECT_EQ(rows, (std::vector<std::vector<std::string>>{{"x", "y"}, {"z", ""}}));
    EXPECT_TRUE(Reader::parse(R"({"a": []})", "f").text_rows("a", 2).empty());
    for (const char* bad : {R"({"a": 1})", R"({"a": ["x", "y"]})", R"({"a": [["x"]]})", R"({"a": [["x", 1]]})", "{}"})
        EXPECT_THROW(Reader::parse(bad, "f").text_rows("a", 2), core::InputError) << bad;
}

TEST(Json, WhatNobodyAskedForIsRefused)
{
    expect_refused(R"({"tolerance": 1, "tolerence": 2})", "tolerence: unknown key, did you mean \"tolerance\"?",
                   [](Reader& r) { r.number("tolerance"), r.reject_unknown_keys(); });
    expect_refused(R"({"a": {"zzzzzz": 2}})", "a.zzzzzz: unknown key",
                   [](Reader& r) { r.object("a").reject_unknown_keys(); });
}

TEST(Json, NumbersReadBackToTheSameDouble)
{
    Value value;
    const Eigen::VectorXd numbers = Eigen::Vector4d(0.1, -1.0 / 3, 5e-324, std::numeric_limits<double>::max());
    value.set("numbers", numbers).set("nan", std::nan("")).set("text", "a \"b\" \n \x01 ä").set("empty", Value());
    std::ostringstream out;
    out << value;
    Reader reader = Reader::parse(out.str(), "file");
    EXPECT_EQ(reader.vector("numbers"), numbers);
    EXPECT_TRUE(reader.is_null_or_missing("nan"));
    EXPECT_EQ(reader.text("text"), "a \"b\" \n \x01 ä");
    reader.object("empty").reject_unknown_keys();
    reader.reject_unknown_keys();
}

TEST(Json, LeavesCarryTheirPaths)
{
    const std::vector<Leaf> found = flatten(R"({"a": [1, {"b": null}], "c": {}, "d": "x", "e": false})", "file");
    std::string list;
    for (const Leaf& leaf : found) list += leaf.path + "=" + to_text(leaf) + ";";
    EXPECT_EQ(list, "a[0]=1;a[1].b=null;c={};d=\"x\";e=false;");
}

} // namespace json_test
} // namespace fettle::json
