#include "cloud/ply_header.h"

#include "core/error.h"
#include "core/lines.h"

#include <algorithm>
#include <utility>

namespace fettle::cloud {

namespace {

constexpr std::size_t kMaxPlyLineBytes = 1 << 16; // as for PCD
constexpr std::size_t kMaxLines = 1000;
constexpr std::size_t kMaxCount = 4294967294; // indices are 32 bits wide

using Property = PlyHeader::Property;
using Words = std::vector<std::string_view>;

struct TypeName {
    std::string_view name;
    char type;
    int size;
};
constexpr TypeName kTypes[] = {{"char", 'I', 1},  {"int8", 'I', 1},    {"uchar", 'U', 1},  {"uint8", 'U', 1},
                               {"short", 'I', 2}, {"int16", 'I', 2},   {"ushort", 'U', 2}, {"uint16", 'U', 2},
                               {"int", 'I', 4},   {"int32", 'I', 4},   {"uint", 'U', 4},   {"uint32", 'U', 4},
                               {"float", 'F', 4}, {"float32", 'F', 4}, {"double", 'F', 8}, {"float64", 'F', 8}};

class PlyHeaderParser : core::FileLines {
  public:
    using core::FileLines::FileLines;

    PlyHeader parse()
    {
        bool ended = false;
        bool encoded = false;
        while (!ended && next_line()) {
            const Words words = fettle::core::words(line());
            if (words.size() == 3 && words[0] == "comment" && words[1] == "frame" && words[2] == "job")
                header_.frame = Frame::job;
            if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
            if (number() == 1 && words.size() == 1 && words[0] == "ply") continue;
            if (words[0] == "format")
                read_format(words, std::exchange(encoded, true));
            else if (words[0] == "element")
                read_element(words);
            else if (words[0] == "property")
                read_property(words);
            else if (words[0] == "end_header")
                ended = true;
            else
                refuse("expected a PLY header entry, got " + core::in_quotes(words[0]));
        }
        if (!ended) throw core::InputError(source_, "the header ends without end_header");
        if (!encoded) throw core::InputError(source_, "header without format");
        header_.body = offset();
        header_.lines = number();
        return header_;
    }

  private:
    bool next_line()
    {
        if (!next_short(kMaxPlyLineBytes)) return false;
        if (number() > kMaxLines) refuse("no end_header within " + std::to_string(kMaxLines) + " lines");
        return true;
    }

    void read_format(const Words& words, bool again)
    {
        if (again) refuse("format is duplicated");
        if (words.size() != 3 || words[2] != "1.0")
            refuse("expected 'format ENCODING 1.0', got " + core::in_quotes(line()));
        if (words[1] == "ascii")
            header_.encoding = PlyHeader::Encoding::ascii;
        else if (words[1] == "binary_little_endian")
            header_.encoding = PlyHeader::Encoding::little_endian;
        else if (words[1] == "binary_big_endian")
            header_.encoding = PlyHeader::Encoding::big_endian;
        else
            refuse("format: " + core::in_quotes(words[1]) +
                   " is none of ascii, binary_little_endian, binary_big_endian");
    }

    void read_element(const Words& words)
    {
        if (words.size() != 3) refuse("expected 'element NAME COUNT', got " + core::in_quotes(line()));
        const std::optional<std::size_t> count = core::parse_integer<std::size_t>(words[2]);
        if (!count || *count > kMaxCount)
            refuse("element " + std::string(words[1]) + ": expected a number from 0 to " + std::to_string(kMaxCount) +
                   ", got " + core::in_quotes(words[2]));
        if (std::ranges::find(header_.elements, words[1], &PlyHeader::Element::name) != header_.elements.end())
            refuse("element " + core::in_quotes(words[1]) + " is duplicated");
        header_.elements.push_back({std::string(words[1]), *count, {}});
    }

    TypeName type_named(std::string_view name) const
    {
        const auto type = std::ranges::find(kTypes, name, &TypeName::name);
        if (type == std::end(kTypes)) refuse("property: unknown type " + core::in_quotes(name));
        return *type;
    }

    void read_property(const Words& words)
    {
        if (header_.elements.empty()) refuse("property before the first element");
        const bool list = words.size() == 5 && words[1] == "list";
        if (!list && words.size() != 3) refuse("expected 'property TYPE NAME', got " + core::in_quotes(line()));
        const TypeName value = type_named(words[list ? 3 : 1]);
        Property property{std::string(words.back()), value.type, value.size, list, 1, false};
        if (list) {
            const TypeName count = type_named(words[2]);
            if (count.type == 'F') refuse("property: a list's length of type " + core::in_quotes(words[2]));
            property.count_size = count.size;
            property.count_signed = count.type == 'I';
        }
        std::vector<Property>& properties = header_.elements.back().properties;
        if (std::ranges::find(properties, property.name, &Property::name) != properties.end())
            refuse("property " + core::in_quotes(property.name) + " is duplicated");
        properties.push_back(std::move(property));
    }

    PlyHeader header_;
};

} // namespace

PlyHeader parse_ply_header(std::string_view bytes, const std::string& source)
{
    return PlyHeaderParser(bytes, source).parse();
}

} // namespace fettle::cloud
