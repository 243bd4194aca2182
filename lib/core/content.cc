#include "core/content.h"

#include "core/lines.h"
#include "core/wrong_kind.h"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <cstring>

namespace fettle::core {

namespace {

/// First bytes of a format.
struct Signature {
    std::string_view bytes;
    std::string_view name;
};

using namespace std::string_view_literals; // signatures contain zero bytes

/// What lies beside scans and programs in the folders of a shop or a lab, and what downloads turn into.
constexpr Signature kSignatures[] = {
    {"\x89PNG\r\n"sv, "a PNG picture"},
    {"\xff\xd8\xff"sv, "a JPEG picture"},
    {"GIF8"sv, "a GIF picture"},
    {"II*\0"sv, "a TIFF picture"},
    {"MM\0*"sv, "a TIFF picture"},
    {"%PDF-"sv, "a PDF document"},
    {"%!PS"sv, "a PostScript document"},
    {"\x1f\x8b"sv, "compressed by gzip"},
    {"BZh"sv, "compressed by bzip2"},
    {"\xfd"
     "7zXZ\0"sv,
     "compressed by xz"},
    {"\x28\xb5\x2f\xfd"sv, "compressed by zstd"},
    {"PK\3\4"sv, "a ZIP archive (also 3MF, DOCX, XLSX)"},
    {"7z\xbc\xaf"sv, "a 7z archive"},
    {"\x7f"
     "ELF"sv,
     "a program (ELF)"},
    {"MZ\x90\0"sv, "a Windows program"},
    {"ASTM-E57"sv, "an E57 scan"},
    {"LASF"sv, "a LAS scan"},
    {"glTF"sv, "a glTF model"},
    {"Kaydara FBX"sv, "an FBX model"},
    {"ISO-10303-21"sv, "a STEP model"},
    {"# vtk DataFile"sv, "a VTK file"},
    {"<?xml"sv, "XML"},
    {"<!DOCTYPE html"sv, "an HTML page"},
    {"<html"sv, "an HTML page"},
};

bool starts_with_ignoring_case(std::string_view bytes, std::string_view start)
{
    const auto lower = [](char c) { return std::tolower(static_cast<unsigned char>(c)); };
    return bytes.size() >= start.size() && std::ranges::equal(bytes.substr(0, start.size()), start, {}, lower, lower);
}

/// Header, number of facets in little-endian order, and 50 bytes for each of them make its size.
bool has_size_of_binary_stl(std::string_view bytes)
{
    constexpr std::size_t kTextBytes = 80, kFacetBytes = 50;
    std::uint32_t facets = 0;
    if (bytes.size() < kTextBytes + sizeof facets) return false;
    std::memcpy(&facets, bytes.data() + kTextBytes, sizeof facets);
    return bytes.size() == kTextBytes + sizeof facets + kFacetBytes * std::size_t{facets};
}

/// By its mark, or by the zeros of its first two characters.
bool is_utf16(std::string_view bytes)
{
    if (bytes.starts_with("\xff\xfe") || bytes.starts_with("\xfe\xff")) return true;
    constexpr std::size_t kTwoCharacters = 4; // bytes
    if (bytes.size() < kTwoCharacters) return false;
    const auto are_text = [&](std::size_t first, std::size_t second) {
        return bytes[first] >= ' ' && bytes[second] >= ' ';
    };
    const auto are_zero = [&](std::size_t first, std::size_t second) {
        return bytes[first] == '\0' && bytes[second] == '\0';
    };
    return (are_text(0, 2) && are_zero(1, 3)) || (are_zero(0, 2) && are_text(1, 3));
}

/// Whether the beginning has bytes that no text has. A binary PCD or PLY begins with text, and says which it is.
bool begins_binary(std::string_view bytes)
{
    constexpr std::size_t kMaxBytes = 1 << 10; // every tenth of random bytes is a control character
    const auto is_control = [](char c) {
        constexpr std::string_view kSpace = "\t\n\r\f\v\x1a"; // the last ends texts of DOS
        return static_cast<unsigned char>(c) < ' ' && kSpace.find(c) == std::string_view::npos;
    };
    if (bytes.starts_with("# .PCD") || bytes.starts_with("ply")) return false;
    return std::ranges::any_of(bytes.substr(0, kMaxBytes), is_control);
}

} // namespace

std::optional<std::string> describe_content(std::string_view bytes)
{
    if (bytes.empty()) return "empty";
    if (has_size_of_binary_stl(bytes)) return "a binary STL mesh";
    for (const Signature& signature : kSignatures)
        if (starts_with_ignoring_case(bytes, signature.bytes)) return std::string(signature.name);
    if (is_utf16(bytes)) return "text in UTF-16";
    if (bytes.find_first_not_of('\0') == std::string_view::npos) return "nothing but zero bytes";
    if (begins_binary(bytes)) return "binary data of no known format";
    return std::nullopt;
}

void refuse_other_content(std::string_view bytes, const std::string& source, const std::string& expected)
{
    if (const std::optional<std::string> content = describe_content(bytes))
        throw WrongFileType(source, *content + ", expected " + expected);
}

} // namespace fettle::core
