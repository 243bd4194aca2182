#include "cloud/cloud.h"
#include "cloud/cloud_writer.h"
#include "cloud/element.h"
#include "cloud/fields.h"
#include "cloud/pcd.h"
#include "cloud/point_source.h"
#include "cloud/poses.h"
#include "core/error.h"
#include "own_folder.h"

#include <gtest/gtest.h>
#include <pcl/io/lzf.h>
#include <pcl/io/pcd_io.h>
#include <pcl/PCLPointCloud2.h>

#include <array>
#include <cmath>
#include <fstream>
#include <limits>
#include <random>
#include <sstream>

namespace fettle {
namespace cloud_test {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

std::string message_of(const std::string& bytes, std::optional<units::Units> units = std::nullopt)
{
    try {
        cloud::parse_cloud(bytes, "file", units);
    } catch (const core::InputError& error) {
        return error.what();
    }
    return "accepted";
}

void expect_refused(const std::string& bytes, const std::string& part, const std::string& because)
{
    const std::string message = message_of(bytes);
    EXPECT_NE(message, "accepted") << because;
    EXPECT_EQ(message.find("file: "), 0u) << message;
    EXPECT_NE(message.find(part), std::string::npos) << because << "\n  " << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
}

std::string header(const std::string& fields, const std::string& size, const std::string& type, int points,
                   const std::string& data = "ascii", const std::string& count = "")
{
    return "VERSION 0.7\nFIELDS " + fields + "\nSIZE " + size + "\nTYPE " + type + "\n" +
           (count.empty() ? "" : "COUNT " + count + "\n") + "WIDTH " + std::to_string(points) +
           "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + std::to_string(points) + "\nDATA " + data + "\n";
}

std::string xyz_header(int points, const std::string& data = "ascii")
{
    return header("x y z", "4 4 4", "F F F", points, data);
}

std::string replaced(std::string text, const std::string& from, const std::string& to)
{
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return text.replace(at, from.size(), to);
}

std::string written(const cloud::Cloud& cloud, cloud::PcdEncoding encoding, const units::Units& units = {})
{
    std::ostringstream out;
    cloud::write_pcd(out, cloud, units, encoding);
    return out.str();
}

// Every type that PCD has, a field of several elements, and padding; values that a float cannot hold.
cloud::Cloud cloud_of_all_types(int points)
{
    std::mt19937_64 random(1);
    cloud::Cloud cloud;
    cloud.xyz.resize(3, points);
    std::uniform_real_distribution<float> place(-100, 100);
    for (double& coordinate : cloud.xyz.reshaped()) coordinate = place(random);
    cloud.xyz.col(1).setConstant(kNan);
    const auto add = [&](const std::string& name, char type, int size, int count) {
        cloud::Field& field = cloud.fields.emplace_back(cloud::Field{name, type, size, count, {}});
        field.bytes.resize(static_cast<std::size_t>(points * size * count));
        for (std::size_t i = 0; i < field.bytes.size() / static_cast<std::size_t>(size); ++i)
            cloud::visit_element(type, size, [&](auto zero) {
                using T = decltype(zero);
                T value = static_cast<T>(random());
                if constexpr (std::is_floating_point_v<T>)
                    value = std::exp(T(0.25) * static_cast<T>(int(i % 700) - 350));
                cloud::store(field.bytes.data() + i * sizeof(T), value);
            });
    };
    for (const char type : {'I', 'U'})
        for (const int size : {1, 2, 4, 8}) add(std::string(1, type) + std::to_string(size), type, size, 1);
    add("single", 'F', 4, 1);
    add("_", 'U', 1, 3);
    add("histogram", 'F', 4, 33);
    add("_", 'U', 1, 5);
    add("double", 'F', 8, 2);
    cloud.view_origin << 1.5, -2.25, 1e-3;
    cloud.view_orientation = Eigen::Quaterniond(0.5, -0.5, 0.5, 0.5);
    return cloud;
}

void expect_same(const cloud::Cloud& a, const cloud::Cloud& b)
{
    ASSERT_EQ(a.size(), b.size());
    for (Eigen::Index i = 0; i < a.size(); ++i)
        for (int axis = 0; axis < 3; ++axis)
            EXPECT_TRUE(a.xyz(axis, i) == b.xyz(axis, i) || (std::isnan(a.xyz(axis, i)) && std::isnan(b.xyz(axis, i))));
    ASSERT_EQ(a.fields.size(), b.fields.size());
    for (std::size_t f = 0; f < a.fields.size(); ++f) {
        EXPECT_EQ(a.fields[f].name, b.fields[f].name);
        EXPECT_EQ(a.fields[f].type, b.fields[f].type);
        EXPECT_EQ(a.fields[f].size, b.fields[f].size);
        EXPECT_EQ(a.fields[f].count, b.fields[f].count);
        EXPECT_EQ(a.fields[f].bytes, b.fields[f].bytes) << a.fields[f].name;
    }
    EXPECT_EQ(a.view_origin, b.view_origin);
    EXPECT_EQ(a.view_orientation.coeffs(), b.view_orientation.coeffs());
    EXPECT_EQ(a.width, b.width);
}

TEST(Pcd, WritingAndReadingKeepsEveryByte)
{
    cloud::Cloud cloud = cloud_of_all_types(5000); // more than are packed at once
    for (const std::size_t width : {0, 1000}) {
        cloud.width = width;
        for (const cloud::PcdEncoding encoding : {cloud::PcdEncoding::ascii, cloud::PcdEncoding::binary}) {
            const std::string bytes = written(cloud, encoding);
            const cloud::CloudFile back = cloud::parse_cloud(bytes, "file");
            expect_same(cloud, back.cloud);
            EXPECT_EQ(written(back.cloud, encoding), bytes);
        }
    }
}

// PCL's own reader, an independent one, finds the same numbers in what we write, and we in what it writes.
TEST(Pcd, AgreesWithPcl)
{
    cloud::Cloud cloud = cloud_of_all_types(40);
    std::erase_if(cloud.fields,
                  [](const cloud::Field& field) { // PCL has no 8 byte integers in 1.13's ascii; it drops padding
                      return field.name == "_" || (field.type != 'F' && field.size == 8);
                  });
    const OwnFolder folder;
    const std::string path = "cloud.pcd";
    for (const cloud::PcdEncoding encoding : {cloud::PcdEncoding::ascii, cloud::PcdEncoding::binary}) {
        std::ofstream(path, std::ios::binary) << written(cloud, encoding);
        pcl::PCLPointCloud2 theirs;
        Eigen::Vector4f origin;
        Eigen::Quaternionf orientation;
        ASSERT_EQ(pcl::io::loadPCDFile(path, theirs, origin, orientation), 0);
        ASSERT_EQ(theirs.width * theirs.height, cloud.size());
        ASSERT_EQ(theirs.fields.size(), cloud.fields.size() + 3);
        EXPECT_EQ(origin.head<3>(), cloud.view_origin.cast<float>());
        for (Eigen::Index i = 0; i < cloud.size(); ++i) {
            const std::uint8_t* point = theirs.data.data() + i * theirs.point_step;
            for (int axis = 0; axis < 3; ++axis) {
                const double x = cloud::load<float>(point + theirs.fields[static_cast<std::size_t>(axis)].offset);
                EXPECT_TRUE(x == cloud.xyz(axis, i) || (std::isnan(x) && std::isnan(cloud.xyz(axis, i))));
            }
            for (std::size_t f = 0; f < cloud.fields.size(); ++f) {
                const cloud::Field& field = cloud.fields[f];
                EXPECT_EQ(theirs.fields[f + 3].name, field.name);
                const auto block = static_cast<std::size_t>(field.size * field.count);
                EXPECT_EQ(std::memcmp(point + theirs.fields[f + 3].offset,
                                      field.bytes.data() + static_cast<std::size_t>(i) * block, block),
                          0)
                    << field.name << ' ' << i;
            }
        }
        if (encoding == cloud::PcdEncoding::ascii) continue;
        pcl::PCDWriter().writeBinaryCompressed(path, theirs, origin, orientation);
        std::ostringstream compressed;
        compressed << std::ifstream(path, std::ios::binary).rdbuf();
        expect_same(cloud, cloud::parse_cloud(compressed.str(), "compressed").cloud);
        expect_same(cloud, cloud::parse_cloud(compressed.str() + "\n", "compressed").cloud);
        pcl::PCDWriter().writeBinary(path, theirs, origin, orientation); // with zeros after the last point
        expect_same(cloud, cloud::read_cloud(path).cloud);
    }
}

TEST(Pcd, PositionsOfAnyType)
{
    const cloud::Cloud ascii =
        cloud::parse_cloud(header("z a y x", "8 4 2 4", "F F I I", 1) + "0.1 7 -3 2000000000\n", "file").cloud;
    EXPECT_EQ(ascii.xyz.col(0), Eigen::Vector3d(2e9, -3, 0.1));
    ASSERT_EQ(ascii.fields.size(), 1u);
    EXPECT_EQ(cloud::field(ascii, "a")[0], 7);
}

TEST(Pcd, WhatCanBeReadSafelyIsRead)
{
    const std::string plain = xyz_header(2) + "1 2 3\nnan -inf 4\n";
    for (std::string text : {plain, "\xef\xbb\xbf" + plain, plain.substr(0, plain.size() - 1), plain + "\n \n"}) {
        const cloud::Cloud cloud = cloud::parse_cloud(text, "file").cloud;
        ASSERT_EQ(cloud.size(), 2);
        EXPECT_TRUE(std::isnan(cloud.xyz(0, 1)));
        EXPECT_EQ(cloud.xyz(1, 1), -std::numeric_limits<double>::infinity());
    }
    std::string crlf;
    for (const char c : plain) crlf += c == '\n' ? "\r\n" : std::string(1, c);
    EXPECT_EQ(cloud::parse_cloud(crlf, "file").cloud.size(), 2);
    EXPECT_EQ(cloud::parse_cloud(xyz_header(0), "file").cloud.size(), 0);
    EXPECT_EQ(cloud::parse_cloud(replaced(xyz_header(1), "POINTS 1\n", "") + "1 2 3", "file").cloud.size(), 1);
    EXPECT_EQ(cloud::parse_cloud(xyz_header(1) + "1e7 10000000.0001 1e-42\n", "file").cloud.xyz(0, 0), 1e7);
}

TEST(Pcd, HeadersThatLieAreRefused)
{
    const std::string row = "1 2 3\n";
    const std::string good = xyz_header(1) + row;
    EXPECT_EQ(message_of(good), "accepted");
    expect_refused("", "empty", "no bytes");
    expect_refused(xyz_header(5), "POINTS 5", "no rows");
    expect_refused(replaced(replaced(good, "WIDTH 1", "WIDTH 4294967295"), "POINTS 1", "POINTS 4294967295"),
                   "4294967295", "10 bytes of body");
    expect_refused(replaced(replaced(replaced(xyz_header(0), "WIDTH 0", "WIDTH 65536"), "HEIGHT 1", "HEIGHT 65536"),
                            "POINTS 0", "POINTS 0"),
                   "WIDTH 65536 times HEIGHT 65536", "wraps in 32 bits");
    expect_refused(replaced(good, "WIDTH 1", "WIDTH -1"), "'-1'", "negative width");
    expect_refused(replaced(good, "WIDTH 1", "WIDTH 99999999999999999999"), "WIDTH", "beyond 64 bits");
    expect_refused(replaced(good, "VERSION 0.7", "POINTS 1"), "line 1: POINTS before FIELDS", "order");
    expect_refused(replaced(good, "DATA ascii\n", ""), "expected a PCD header entry, got '1'", "no DATA");
    expect_refused(good.substr(0, good.find("DATA")), "without DATA", "ends before DATA");
    expect_refused(replaced(good, "DATA ascii", "DATA text"), "'text'", "unknown DATA");
    expect_refused(replaced(good, "DATA ascii", "DATA"), "DATA", "DATA without a word");
    for (const char* size : {"0 4 4", "3 4 4", "9 4 4"}) {
        expect_refused(replaced(good, "4 4 4", size), std::string(1, size[0]), size);
    }
    expect_refused(replaced(good, "F F F", "F F G"), "'G4'", "unknown type");
    expect_refused(header("x y z a", "4 4 4 2", "F F F F", 1) + "1 2 3 4\n", "'F2'", "no float of two bytes");
    for (const char* count : {"1 1 1 0", "1 1 1 -1", "1 1 1 1000000000"})
        expect_refused(header("x y z a", "4 4 4 4", "F F F F", 1, "ascii", count) + "1 2 3 4\n", "COUNT", count);
    expect_refused(header("x y z", "4 4 4", "F F F", 1, "ascii", "1 1 2") + "1 2 3 4\n", "'z': COUNT 2", "two z");
    expect_refused(replaced(good, "4 4 4", "4 4"), "SIZE: 2 values for 3 fields", "fewer SIZE");
    expect_refused(replaced(good, "x y z", "x x z"), "no field 'y'", "no y");
    expect_refused(header("x y z x", "4 4 4 4", "F F F F", 1) + "1 2 3 4\n", "'x' is duplicated", "two x");
    expect_refused(header("a b", "4 4", "F F", 1) + "1 2\n", "no field 'x'", "no position");
    for (const char* view : {"0 0 0 1 0 0", "0 0 0 0 0 0 0", "0 0 nan 1 0 0 0"})
        expect_refused(replaced(good, "0 0 0 1 0 0 0", view), "line 7: VIEWPOINT", view);
    expect_refused(replaced(good, "HEIGHT 1", "HEIGHT 1\nHEIGHT 1"), "HEIGHT is duplicated", "repeated entry");
    expect_refused(replaced(good, "VERSION 0.7", "VERSION 0.7\nCOLOUR 3"), "'COLOUR'", "unknown entry");
    expect_refused(replaced(good, "VERSION 0.7", std::string("VERSION\0 0.7", 12)), "zero byte", "NUL");
    expect_refused("# " + std::string(1 << 20, 'a') + "\n" + good, "line 1: longer", "a long line");
    std::string cr = good;
    std::replace(cr.begin(), cr.end(), '\n', '\r');
    expect_refused(cr, "carriage return", "CR only");
    std::string wide = "\xff\xfe";
    for (const char c : good) wide += {c, '\0'};
    expect_refused(wide, "UTF-16", "with a mark");
    expect_refused(wide.substr(2), "text in UTF-16, expected points", "without a mark");
    expect_refused("\x89PNG\r\n\x1a\n", "a PNG picture, expected points", "a picture");
    expect_refused("solid a\n", "a mesh, expected points", "a mesh");
    expect_refused(std::string(1000, '\n'), "without DATA", "blank lines");
    expect_refused(replaced(replaced(replaced(good, "WIDTH 1\n", ""), "HEIGHT 1\n", ""), "POINTS 1\n", ""),
                   "without WIDTH or POINTS", "no number of points");
    std::string names, sizes, types, counts; // 2^32 points of more than 2^32 bytes
    for (int i = 0; i < 8193; ++i) names += " _", sizes += " 8", types += " F", counts += " 65536";
    expect_refused(
        replaced(replaced(header("x y z" + names, "4 4 4" + sizes, "F F F" + types, 1, "binary", "1 1 1" + counts),
                          "WIDTH 1", "WIDTH 4294967295"),
                 "POINTS 1", "POINTS 4294967295"),
        "POINTS 4294967295 of 4295491596 bytes are more than any file holds", "beyond 64 bits");
}

TEST(Pcd, RowsAreHeldAgainstTheHeader)
{
    const auto with = [](const std::string& row) { return xyz_header(2) + "1.25 2.25 3.25\n" + row + "\n"; };
    expect_refused(with("1 2"), "line 11: expected 3 numbers, got 2", "too few");
    expect_refused(with("1 2 3 4"), "line 11: expected 3 numbers, got 4", "too many");
    expect_refused(with("1,5 2 3"), "line 11: field 'x': '1,5'", "decimal comma");
    expect_refused(with("1 1e400 3"), "'1e400'", "beyond double");
    expect_refused(with("1 2 1e39"), "'1e39'", "beyond float");
    expect_refused(with("1 2 3\n4 5 6"), "line 12: more rows than POINTS 2", "one too many");
    expect_refused(xyz_header(3) + "1 2 3\n4 5 6\n    \n", "only 2 rows", "one missing");
    expect_refused(with("1 2 3") + with("1 2 3"), "another PCD follows", "two files in one");
    expect_refused(header("x y z c", "4 4 4 1", "F F F U", 1) + "1 2 3 256\n", "'256' is not a number of type U1",
                   "range");
    expect_refused(header("x y z c", "4 4 4 1", "F F F U", 1) + "1 2 3 -1\n", "'-1'", "sign");
    expect_refused(header("x y z c", "4 4 4 4", "F F F I", 1) + "1 2 3 1.5\n", "'1.5'", "no whole number");
}

TEST(Pcd, BinaryBodiesAreHeldAgainstTheHeader)
{
    const std::string body(24, '\1');
    EXPECT_EQ(message_of(xyz_header(2, "binary") + body), "accepted");
    expect_refused(xyz_header(2, "binary") + body.substr(1), "need 24 bytes, there are 23", "a byte short");
    expect_refused(xyz_header(2, "binary") + body + "\n", "need 24 bytes, there are 25", "a byte more");
    // PCL's zeros make up for what the header is shorter than a page of memory.
    const std::string header = xyz_header(2, "binary"), zeros(4096 - header.size(), '\0');
    EXPECT_EQ(message_of(header + body + zeros), "accepted");
    expect_refused(header + body + zeros + '\0', "need 24 bytes, there are ", "a zero more");
    expect_refused(header + body + zeros.substr(1), "need 24 bytes, there are ", "a zero less");
    expect_refused(header + body + zeros.substr(1) + '\1', "need 24 bytes, there are ", "no zero");
    expect_refused(xyz_header(2, "binary") + body + xyz_header(0, "binary"), "another PCD follows", "two in one");
    expect_refused(xyz_header(2, "binary") + "1 2 3\n4 5 6\n", "there are 12", "ascii rows under a binary header");
}

std::string packed(const std::string& bytes, std::uint32_t size, std::uint32_t unpacked_size)
{
    std::string body(8, '\0');
    cloud::store(body.data(), size);
    cloud::store(body.data() + 4, unpacked_size);
    return body + bytes;
}

TEST(Pcd, CompressedBodiesAreHeldAgainstTheHeader)
{
    const std::string start = xyz_header(2, "binary_compressed");
    const std::string literal = "\x17" + std::string(24, '\1'); // 24 bytes as they are
    EXPECT_EQ(message_of(start + packed(literal, 25, 24)), "accepted");
    EXPECT_EQ(message_of(start + packed(literal, 25, 24) + std::string(4000, '\0')), "accepted") << "filled to a page";
    EXPECT_EQ(message_of(xyz_header(0, "binary_compressed") + packed("", 0, 0)), "accepted");
    expect_refused(start, "compressed body of 0 bytes", "nothing");
    expect_refused(start + packed(literal, 26, 24), "there are 25", "says more than there is");
    expect_refused(start + packed(literal, 24, 24), "after the compressed body", "says less than there is");
    expect_refused(start + packed(literal, 25, 25), "the compressed body says 25", "not the size of the points");
    expect_refused(start + packed(literal, 4294967295, 24), "4294967295", "a size near the limit");
    expect_refused(start + packed("\x20\xff", 2, 24), "corrupt", "a reference before the beginning");
    expect_refused(start + packed(std::string("\x00\x01\xe0", 3), 3, 24), "corrupt", "a reference that ends early");
    expect_refused(start + packed("\x17\x01", 2, 24), "corrupt", "a run that ends early");
    const std::string huge = replaced(replaced(start, "WIDTH 2", "WIDTH 100000000"), "POINTS 2", "POINTS 100000000");
    expect_refused(huge + packed(literal, 25, 1200000000), "cannot hold", "more than LZF can pack");
}

// PCL packs, we unpack; a byte less or noise is refused.
TEST(Pcd, UnpacksWhatPclPacks)
{
    constexpr int kPoints = 20000;
    const auto file_of = [](const std::string& bytes) {
        return header("x y z", "1 1 1", "U U U", kPoints, "binary_compressed") +
               packed(bytes, std::uint32_t(bytes.size()), 3 * kPoints);
    };
    std::mt19937 random(1);
    for (const int letters : {1, 2, 5, 100}) {
        std::string text(3 * kPoints, '\0'); // all x, all y, all z
        for (char& c : text) c = static_cast<char>(random() % unsigned(letters));
        std::string small(2 * text.size(), '\0');
        small.resize(pcl::lzfCompress(text.data(), unsigned(text.size()), small.data(), unsigned(small.size())));
        ASSERT_FALSE(small.empty());
        const cloud::Cloud cloud = cloud::parse_cloud(file_of(small), "file").cloud;
        for (int axis = 0; axis < 3; ++axis)
            for (int i = 0; i < kPoints; ++i)
                ASSERT_EQ(cloud.xyz(axis, i), text[std::size_t(axis * kPoints + i)]) << letters << ' ' << i;
        small.pop_back();
        EXPECT_EQ(message_of(file_of(small)), "file: the compressed body is corrupt");
    }
    std::string noise(1000, '\0');
    for (int trial = 0; trial < 1000; ++trial) {
        for (char& c : noise) c = static_cast<char>(random());
        EXPECT_EQ(message_of(file_of(noise)), "file: the compressed body is corrupt");
    }
}

TEST(Units, CommentIsReadAndHeldAgainstTheJob)
{
    const units::Units inches{units::Units::Length::in, units::Units::Force::lbf};
    const std::string text = header("x y z force error", "4 4 4 8 8", "F F F F F", 1) + "1 2 3 4 5\n";
    const cloud::CloudFile plain = cloud::parse_cloud(text, "file");
    EXPECT_EQ(plain.cloud.xyz(0, 0), 1);
    EXPECT_EQ(cloud::field(plain.cloud, "force")[0], 4);
    const cloud::CloudFile parsed = cloud::parse_cloud(text, "file", inches);
    EXPECT_DOUBLE_EQ(parsed.cloud.xyz(0, 0), 25.4);
    EXPECT_DOUBLE_EQ(cloud::field(parsed.cloud, "force")[0], 4 * 4.4482216152605);
    EXPECT_DOUBLE_EQ(cloud::field(parsed.cloud, "error")[0], 5 * 25.4);
    const cloud::CloudFile stated = cloud::parse_cloud("# units in lbf\n" + text, "file");
    EXPECT_EQ(stated.units, inches);
    EXPECT_DOUBLE_EQ(cloud::field(stated.cloud, "force")[0], 4 * 4.4482216152605);
    EXPECT_EQ(message_of("# units in\n" + text, inches), "accepted");
    EXPECT_EQ(message_of("# units in lbf\n" + text, units::Units{}), "file: units: the file says in, expected mm");
    EXPECT_EQ(message_of("# units in N\n" + text, inches), "file: units: the file says N, expected lbf");
    expect_refused("# units furlong\n" + text, "line 1: unknown length unit 'furlong'", "no unit");
    expect_refused("# units mm\n# units in\n" + text, "line 2: second units", "two units");
    expect_refused("# units mm kg\n" + text, "line 1: unknown force unit 'kg'", "no force");
    expect_refused("# units mm N s\n" + text, "expected '# units LENGTH [FORCE]', got '# units mm N s'", "three units");
}

TEST(Units, FieldsWithUnitsAreWrittenInThem)
{
    const units::Units inches{units::Units::Length::in, units::Units::Force::lbf};
    cloud::Cloud cloud;
    cloud.xyz = Eigen::Vector3d(25.4, 0, -50.8);
    for (const char* name : {"error", "feed", "force", "curve"})
        cloud::set_field(cloud, name, Eigen::VectorXd::Constant(1, 25.4), 8);
    cloud.view_origin << 25.4, 0, 0;
    const std::string bytes = written(cloud, cloud::PcdEncoding::ascii, inches);
    EXPECT_NE(bytes.find("# units in lbf\n"), std::string::npos);
    EXPECT_NE(bytes.find("VIEWPOINT 1 0 0 1 0 0 0\n"), std::string::npos);
    EXPECT_NE(bytes.find("DATA ascii\n1 0 -2 1 1 5.7101471547326"), std::string::npos) << bytes;
    const cloud::CloudFile back = cloud::parse_cloud(bytes, "file", inches);
    for (const char* name : {"error", "feed", "force", "curve"})
        EXPECT_NEAR(cloud::field(back.cloud, name)[0], 25.4, 1e-13);
    std::erase_if(cloud.fields, [](const cloud::Field& f) { return f.name == "force"; });
    EXPECT_NE(written(cloud, cloud::PcdEncoding::ascii, inches).find("# units in\n"), std::string::npos);
}

TEST(Units, BinaryAndAsciiHoldTheSameNumbers)
{
    const units::Units inches{units::Units::Length::in, units::Units::Force::lbf};
    cloud::Cloud cloud = cloud_of_all_types(9000);
    cloud.fields[1].name = "removed"; // whole numbers, which inches make broken ones
    cloud.fields[3].name = "force";
    const auto read = [&](cloud::PcdEncoding encoding) {
        return cloud::parse_cloud(written(cloud, encoding, inches), "file", inches).cloud;
    };
    const cloud::Cloud binary = read(cloud::PcdEncoding::binary), ascii = read(cloud::PcdEncoding::ascii);
    expect_same(binary, ascii);
    for (const char* name : {"removed", "force"})
        EXPECT_TRUE(cloud::field(binary, name).isApprox(cloud::field(cloud, name), 1e-14)) << name;
    EXPECT_TRUE(binary.xyz.rightCols(8998).isApprox(cloud.xyz.rightCols(8998), 1e-7));
}

// A float colour with a full first byte is a NaN, whose bits ascii floats would lose; PCL writes it as a whole number.
TEST(Colours, SurviveAscii)
{
    cloud::Cloud cloud;
    cloud.xyz.setZero(3, 2);
    Eigen::Matrix<std::uint8_t, 3, Eigen::Dynamic> rgb(3, 2);
    rgb << 255, 0, 128, 1, 0, 2;
    cloud::set_colours(cloud, rgb);
    const cloud::Cloud back = cloud::parse_cloud(written(cloud, cloud::PcdEncoding::ascii), "file").cloud;
    EXPECT_EQ(back.fields[0].bytes, cloud.fields[0].bytes);
    EXPECT_EQ(cloud::load<std::uint32_t>(back.fields[0].bytes.data()), 0xff8000u);
}

TEST(Fields, SetGetSelect)
{
    cloud::Cloud cloud;
    cloud.xyz = Eigen::Matrix3Xd::Random(3, 4);
    cloud::set_field(cloud, "a", Eigen::Vector4d(1, 2, 3, 4));
    cloud::set_field(cloud, "b", Eigen::Vector4d(0.1, 0.2, 0.3, 0.4), 8);
    cloud::set_field(cloud, "a", Eigen::Vector4d(5, 6, 7, 8));
    EXPECT_EQ(cloud.fields[0].name, "a");
    EXPECT_EQ(cloud::field(cloud, "b"), Eigen::Vector4d(0.1, 0.2, 0.3, 0.4));
    const cloud::Cloud chosen = cloud::select_points(cloud, {3, 1, 1});
    EXPECT_EQ(cloud::field(chosen, "a"), Eigen::Vector3d(8, 6, 6));
    EXPECT_EQ(chosen.xyz.col(2), cloud.xyz.col(1));
    EXPECT_THROW(cloud::field(cloud, "c"), core::InputError);
    cloud.fields.push_back({"pair", 'U', 1, 2, std::vector<std::byte>(8)});
    EXPECT_THROW(cloud::field(cloud, "pair"), core::InputError);
    EXPECT_FALSE(cloud::has_normals(cloud));
    cloud::set_normals(cloud, Eigen::Matrix3Xd::Ones(3, 4));
    EXPECT_TRUE(cloud::has_normals(cloud));
}

std::string ply(const std::string& format, const std::string& rest)
{
    return "ply\nformat " + format + " 1.0\n" + rest;
}

const std::string kVertex = "element vertex 2\nproperty float x\nproperty float y\nproperty float z\n";

TEST(Ply, AsciiAndBothBinaries)
{
    const std::string properties =
        "comment made by hand\nelement other 1\nproperty list uchar short s\nelement vertex 2\n"
        "property double x\nproperty float y\nproperty short z\nproperty list uchar int l\n"
        "property uchar scalar_error\nproperty float nx\nend_header\n";
    const cloud::Cloud ascii =
        cloud::parse_cloud(ply("ascii", properties) + "2 7 8\n0.1 2 -3 0 200 1\n4 5 6 2 9 9 1 0\n", "file").cloud;
    const auto binary = [&](bool swap) {
        std::string body;
        const auto put = [&](auto value) {
            std::string bytes(sizeof value, '\0');
            cloud::store(bytes.data(), value);
            if (swap) std::reverse(bytes.begin(), bytes.end());
            body += bytes;
        };
        for (int v : {2}) put(std::uint8_t(v));
        for (int v : {7, 8}) put(std::int16_t(v));
        put(0.1), put(2.f), put(std::int16_t(-3)), put(std::uint8_t(0)), put(std::uint8_t(200)), put(1.f);
        put(4.0), put(5.f), put(std::int16_t(6)), put(std::uint8_t(2)), put(9), put(9), put(std::uint8_t(1)), put(0.f);
        return cloud::parse_cloud(ply(swap ? "binary_big_endian" : "binary_little_endian", properties) + body, "file")
            .cloud;
    };
    EXPECT_EQ(ascii.xyz, (Eigen::Matrix3Xd(3, 2) << 0.1, 4, 2, 5, -3, 6).finished());
    EXPECT_EQ(cloud::field(ascii, "error"), Eigen::Vector2d(200, 1));
    EXPECT_EQ(cloud::field(ascii, "normal_x"), Eigen::Vector2d(1, 0));
    expect_same(ascii, binary(false));
    expect_same(ascii, binary(true));
}

TEST(Ply, BadFilesAreRefused)
{
    const auto ascii = [](const std::string& elements, const std::string& body) {
        return ply("ascii", elements + "end_header\n" + body);
    };
    EXPECT_EQ(message_of(ascii(kVertex, "1 2 3\n4 5 6\n")), "accepted");
    for (const char* count : {"99999999999", "-1", "x", "4000000000"})
        expect_refused(replaced(ascii(kVertex, "1 2 3\n"), "vertex 2", std::string("vertex ") + count), count, count);
    expect_refused(replaced(ascii(kVertex, "1 2 3\n"), "vertex 2", "vertex"), "line 3", "no count");
    expect_refused(ascii("element face 0\n", ""), "without element vertex", "no vertex");
    expect_refused(replaced(ascii(kVertex, "1 2 3\n4 5 6\n"), "property float y\n", ""), "without x, y and z", "no y");
    expect_refused(replaced(ascii(kVertex, ""), "float y", "half y"), "unknown type 'half'", "type");
    expect_refused(replaced(ascii(kVertex, "1 2 3 4\n5 6 7 8\n"), "float z", "float z\nproperty float scalar_x"),
                   "be called 'x'", "a scalar x");
    expect_refused(replaced(ascii(kVertex, ""), "float y", "float x"), "'x' is duplicated", "two x");
    expect_refused(replaced(ascii(kVertex, "1 2 3\n"), "end_header\n", ""), "line 7", "no end_header");
    expect_refused(ascii(kVertex, "1 2 3\n"), "only 6 bytes left", "a line missing");
    expect_refused(ascii(kVertex, "1.5 2.5 3.5\n4 5\n"), "property z is missing", "a number missing");
    expect_refused(ascii(kVertex, "1 2 3\n4 5 6 7\n"), "'7'", "a number more");
    expect_refused(ascii(kVertex, "1 2 3\n4 5 6\n7 8 9\n"), "line 10: text after", "a line more");
    expect_refused(ascii(kVertex, "1 2 3\n4 5 x\n"), "'x'", "no number");
    expect_refused(ply("binary_little_endian", kVertex + "end_header\n" + std::string(23, '\1')), "only 23 bytes",
                   "short");
    expect_refused(ply("binary_little_endian", kVertex + "end_header\n" + std::string(25, '\1')), "after the last",
                   "long");
    expect_refused(ply("binary_middle_endian", kVertex), "'binary_middle_endian'", "format");
    expect_refused(replaced(ply("ascii", kVertex), "ascii 1.0", "ascii 2.0"),
                   "expected 'format ENCODING 1.0', got 'format ascii 2.0'", "version");
    expect_refused(ascii(kVertex + "property float nx\nproperty float normal_x\n", "1 2 3 1 1\n4 5 6 1 1\n"),
                   "field 'normal_x' is duplicated", "by two names");
    expect_refused(replaced(ply("ascii", kVertex), "format ascii 1.0\n", "") + "end_header\n", "without format",
                   "none");
    expect_refused(ascii("element a 4000000000\n" + kVertex, ""), "element a without a property", "endless");
    expect_refused(ascii(replaced(kVertex, "z\n", "z\nproperty list float int l\n"), ""), "'float'",
                   "length of a list");
    const std::string list = replaced(kVertex, "z\n", "z\nproperty list char int l\n");
    expect_refused(ascii(list, "1 2 3 -1\n4 5 6 0\n"), "list of -1", "negative length");
    expect_refused(ascii(list, "1 2 3 100 1\n4 5 6 0\n"), "a list of 100", "longer than the line");
    const auto binary = [&](char length) {
        return ply("binary_little_endian",
                   list + "end_header\n" + std::string(12, '\1') + length + std::string(27, '\1'));
    };
    expect_refused(binary('\x80'), "vertex 0: property l: a list of -128", "negative length");
    expect_refused(binary('\x64'), "vertex 0: a list of 100, the file ends", "longer than the file");
}

TEST(Xyz, NamesCommentsAndColumns)
{
    const cloud::Cloud plain = cloud::parse_cloud("# scan\n1 2 3 4\n\n 5\t6 7 nan\n", "file").cloud;
    EXPECT_EQ(plain.xyz.col(1), Eigen::Vector3d(5, 6, 7));
    EXPECT_EQ(cloud::field(plain, "column4")[0], 4);
    EXPECT_EQ(cloud::field(cloud::parse_cloud("//X Y Z intensity\n1 2 3 4\n", "file").cloud, "intensity")[0], 4);
    expect_refused("1 2\n", "line 1: expected at least 3 numbers, got 2", "two columns");
    expect_refused("1 2 3\n1 2 3 4\n", "line 2: expected 3 numbers, got 4", "uneven");
    expect_refused("1 2 3\n1,5 2 3\n", "line 2: '5 2 3' is not a number", "decimal comma");
    expect_refused(std::string("x y z a\0b\n1 2 3 4\n", 18), "be called 'a", "a name with a zero byte");
    expect_refused("x y z a\rb\n1 2 3 4\n", "be called 'a", "a name with a carriage return");
    expect_refused("x y z " + std::string(1 << 16, 'a') + "\n1 2 3 4\n", "names of the fields take", "a long name");
    expect_refused("x y z a a\n1 2 3 4 5\n", "'a' is duplicated", "two names");
}

std::string written(const cloud::Cloud& cloud, cloud::CloudFormat format)
{
    std::ostringstream out;
    cloud::CloudWriter writer(out, format, units::Units{}, static_cast<std::size_t>(cloud.size()));
    writer.write(cloud);
    writer.finish();
    return out.str();
}

// Reference: the names of the types in the VTK user's guide; the numbers by hand, big-endian.
TEST(Ply, SaysTheFrame)
{
    cloud::Cloud cloud;
    cloud.xyz = Eigen::Vector3d(1, 2, 3);
    for (const cloud::Frame frame : {cloud::Frame::part, cloud::Frame::job}) {
        cloud.frame = frame;
        EXPECT_EQ(cloud::parse_cloud(written(cloud, cloud::CloudFormat::ply), "file").cloud.frame, frame);
    }
}

TEST(Poses, MotionsAreGivenOrFollowFromTheStrokes)
{
    cloud::Cloud cloud;
    cloud.xyz = Eigen::Matrix3Xd::Zero(3, 3);
    using enum cloud::Motion;
    EXPECT_EQ(cloud::read_motions(cloud), (std::vector<cloud::Motion>{stroke, stroke, stroke}));
    cloud::set_field(cloud, "stroke", Eigen::Vector3d(0, -1, 1));
    EXPECT_EQ(cloud::read_motions(cloud), (std::vector<cloud::Motion>{stroke, travel, stroke}));
    cloud::set_field(cloud, "motion", Eigen::Vector3d(2, 0, 7));
    try {
        cloud::read_motions(cloud);
        FAIL();
    } catch (const core::InputError& error) {
        EXPECT_STREQ(error.what(), "point 2: motion is 7, expected 0 to 3");
    }
}

TEST(Vtk, HasTheTypesOfTheFields)
{
    cloud::Cloud cloud;
    cloud.xyz = Eigen::Vector3d(1, 2, 3);
    const auto add = [&](char type, int size, const std::string& name) {
        cloud::Field& field = cloud.fields.emplace_back(
            cloud::Field{name, type, size, 1, std::vector<std::byte>(static_cast<std::size_t>(size))});
        field.bytes[0] = std::byte{7};
    };
    const std::pair<int, std::string> names[] = {{1, "char"}, {2, "short"}, {4, "int"}, {8, "long"}};
    for (const auto& [size, name] : names) add('I', size, "i_" + name), add('U', size, "u_" + name);
    const std::string text = written(cloud, cloud::CloudFormat::vtk);
    for (const auto& [size, name] : names) {
        const std::string bytes =
            "\nLOOKUP_TABLE default\n" + std::string(static_cast<std::size_t>(size) - 1, '\0') + '\7';
        EXPECT_NE(text.find("SCALARS i_" + name + " " + name + " 1" + bytes), std::string::npos) << name;
        EXPECT_NE(text.find("SCALARS u_" + name + " unsigned_" + name + " 1" + bytes), std::string::npos) << name;
    }
}

TEST(Csv, NamesEachElement)
{
    cloud::Cloud cloud;
    cloud.xyz = Eigen::Matrix3Xd::Identity(3, 2);
    cloud.fields.push_back({"pair", 'U', 1, 2, {std::byte{1}, std::byte{2}, std::byte{3}, std::byte{4}}});
    cloud::set_field(cloud, "t", Eigen::Vector2d(5, 6));
    EXPECT_EQ(written(cloud, cloud::CloudFormat::csv), "x,y,z,pair_0,pair_1,t\n1,0,0,1,2,5\n0,1,0,3,4,6\n");
}

/// The points of a file as a stream gives them, in blocks.
cloud::Cloud streamed(const std::string& bytes, const std::optional<units::Units>& units = std::nullopt)
{
    const OwnFolder folder;
    const std::string path = "cloud.pcd";
    std::ofstream(path, std::ios::binary) << bytes;
    const cloud::CloudStream stream(path, units);
    const cloud::PointSource& source = stream.points();
    cloud::Cloud cloud;
    cloud.xyz.resize(3, static_cast<Eigen::Index>(source.points));
    Eigen::VectorXd roles(source.has_roles ? cloud.xyz.cols() : 0);
    cloud::PointBlock block;
    for (std::size_t first = 0; first < source.points; first += source.block_size) {
        const std::size_t count = std::min(source.block_size, source.points - first);
        source.read(first, count, block);
        const auto at = static_cast<Eigen::Index>(first), size = static_cast<Eigen::Index>(count);
        cloud.xyz.middleCols(at, size) = block.xyz;
        if (source.has_roles) roles.segment(at, size) = block.roles;
    }
    if (source.has_roles) cloud::set_field(cloud, "role", roles);
    EXPECT_EQ(stream.read_all()->xyz.cwiseAbs().maxCoeff(), cloud.xyz.cwiseAbs().maxCoeff());
    return cloud;
}

// Reference: the same bytes read whole. More than a megabyte, else it is not streamed.
TEST(CloudStream, ReadsWhatReadCloudReads)
{
    std::mt19937 random(5);
    std::uniform_real_distribution<double> number(-100, 100);
    cloud::Cloud cloud;
    cloud.xyz.resize(3, 100000);
    for (double& x : cloud.xyz.reshaped()) x = number(random);
    cloud::set_field(cloud, "role", Eigen::VectorXd::LinSpaced(100000, 0, 5).array().round());
    cloud::set_field(cloud, "t", Eigen::VectorXd::LinSpaced(100000, 0, 1), 8);
    for (const cloud::PcdEncoding encoding : {cloud::PcdEncoding::binary, cloud::PcdEncoding::ascii}) {
        std::ostringstream out;
        cloud::write_pcd(out, cloud, units::Units{units::Units::Length::in, units::Units::Force::N}, encoding);
        const cloud::Cloud whole = cloud::parse_cloud(out.str(), "file").cloud, pieces = streamed(out.str());
        EXPECT_EQ(whole.xyz, pieces.xyz);
        EXPECT_EQ(cloud::field(whole, "role"), cloud::field(pieces, "role"));
    }
}

TEST(CloudStream, RefusesWhatReadCloudRefuses)
{
    cloud::Cloud cloud;
    cloud.xyz.setOnes(3, 100000);
    std::ostringstream out;
    cloud::write_pcd(out, cloud, units::Units{});
    const std::string good = out.str();
    const auto refusal = [](const std::string& bytes) -> std::string {
        try {
            streamed(bytes);
        } catch (const core::InputError& error) {
            const std::string message = error.what();
            return "file" + message.substr(message.find(": "));
        }
        return "accepted";
    };
    EXPECT_EQ(refusal(good), "accepted");
    for (const std::string& bytes :
         {good.substr(0, good.size() - 1), good + "x", good + good, replaced(good, "WIDTH 100000", "WIDTH 99999"),
          replaced(good, "FIELDS x y z", "FIELDS x y y"), replaced(good, "SIZE 4 4 4", "SIZE 4 4 3"),
          replaced(good, "# units mm", "# units ft"), replaced(good, "DATA binary", "DATA binray")}) {
        EXPECT_NE(refusal(bytes), "accepted");
        EXPECT_EQ(refusal(bytes), message_of(bytes));
    }
    EXPECT_THROW(streamed(good, units::Units{units::Units::Length::in, units::Units::Force::N}), core::InputError);
}

} // namespace cloud_test
} // namespace fettle
