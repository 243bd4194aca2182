#include "cloud/ply_header.h"

#include "core/error.h"
#include "core/lines.h"

#include <algorithm>
#include <utility>

namespace fettle {

namespace {

constexpr std::size_t kLongestLine = 1 << 16; // bytes; as for PCD
constexpr std::size_t kMostLines = 1000;
constexpr std::size_t kMostCount = 4294967294; // indices are 32 bits wide

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

class HeaderParser {
  public:
    HeaderParser(std::string_view bytes, const std::string& source) : bytes_(bytes), source_(source), lines_(bytes) {}

    PlyHeader parse()
    {
        bool ended = false;
        bool encoded = false;
        while (!ended && next_line()) {
            const Words found = words(lines_.line());
            if (found.empty() || found[0] == "comment" || found[0] == "obj_info") continue;
            if (lines_.number() == 1 && found.size() == 1 && found[0] == "ply") continue;
            if (found[0] == "format")
                read_format(found, std::exchange(encoded, true));
            else if (found[0] == "element")
                read_element(found);
            else if (found[0] == "property")
                read_property(found);
            else if (found[0] == "end_header")
                ended = true;
            else
                refuse("expected a PLY header entry, got " + in_quotes(found[0]));
        }
        if (!ended) throw InputError(source_, "the header ends without end_header");
        if (!encoded) throw InputError(source_, "header without format");
        header_.body = lines_.offset();
        header_.lines = lines_.number();
        return header_;
    }

  private:
    [[noreturn]] void refuse(const std::string& problem) const
    {
        throw InputError(source_, lines_.place() + ": " + problem);
    }

    bool next_line()
    {
        const std::string_view ahead = bytes_.substr(lines_.offset(), kLongestLine + 1);
        const std::size_t length = std::min(ahead.find('\n'), ahead.size());
        if (!lines_.next()) return false;
        if (length > kLongestLine) refuse("longer than " + std::to_string(kLongestLine) + " bytes");
        if (lines_.number() > kMostLines) refuse("no end_header within " + std::to_string(kMostLines) + " lines");
        return true;
    }

    void read_format(const Words& found, bool again)
    {
        if (again) refuse("format stands twice");
        if (found.size() != 3 || found[2] != "1.0")
            refuse("expected 'format ENCODING 1.0', got " + in_quotes(lines_.line()));
        if (found[1] == "ascii")
            header_.encoding = PlyHeader::Encoding::ascii;
        else if (found[1] == "binary_little_endian")
            header_.encoding = PlyHeader::Encoding::little_endian;
        else if (found[1] == "binary_big_endian")
            header_.encoding = PlyHeader::Encoding::big_endian;
        else
            refuse("format: " + in_quotes(found[1]) + " is none of ascii, binary_little_endian, binary_big_endian");
    }

    void read_element(const Words& found)
    {
        if (found.size() != 3) refuse("expected 'element NAME COUNT', got " + in_quotes(lines_.line()));
        const std::optional<std::size_t> count = parse_whole<std::size_t>(found[2]);
        if (!count || *count > kMostCount)
            refuse("element " + std::string(found[1]) + ": expected a number from 0 to " + std::to_string(kMostCount) +
                   ", got " + in_quotes(found[2]));
        for (const PlyHeader::Element& element : header_.elements)
            if (element.name == found[1]) refuse("element " + in_quotes(found[1]) + " stands twice");
        header_.elements.push_back({std::string(found[1]), *count, {}});
    }

    TypeName type(std::string_view name) const
    {
        for (const TypeName& known : kTypes)
            if (known.name == name) return known;
        refuse("property: unknown type " + in_quotes(name));
    }

    void read_property(const Words& found)
    {
        if (header_.elements.empty()) refuse("property before the first element");
        const bool list = found.size() == 5 && found[1] == "list";
        if (!list && found.size() != 3) refuse("expected 'property TYPE NAME', got " + in_quotes(lines_.line()));
        const TypeName value = type(found[list ? 3 : 1]);
        Property property{std::string(found.back()), value.type, value.size, list, 1, false};
        if (list) {
            const TypeName count = type(found[2]);
            if (count.type == 'F') refuse("property: a list's length of type " + in_quotes(found[2]));
            property.count_size = count.size;
            property.count_signed = count.type == 'I';
        }
        for (const Property& other : header_.elements.back().properties)
            if (other.name == property.name) refuse("property " + in_quotes(property.name) + " stands twice");
        header_.elements.back().properties.push_back(std::move(property));
    }

    std::string_view bytes_;
    const std::string& source_;
    Lines lines_;
    PlyHeader header_;
};

} // namespace

PlyHeader parse_ply_header(std::string_view bytes, const std::string& source)
{
    return HeaderParser(bytes, source).parse();
}

} // namespace fettle
