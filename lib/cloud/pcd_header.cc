#include "cloud/pcd_header.h"

#include "cloud/element.h"
#include "core/error.h"
#include "core/lines.h"
#include "core/text.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace fettle {

namespace {

// Bounds that no real file comes near; they keep a broken one from costing memory.
constexpr std::size_t kLongestLine = 1 << 16;   // bytes; PCL's histograms name a few hundred fields at most
constexpr std::size_t kMostElements = 1 << 16;  // of one field; PCL's longest descriptor has 1344
constexpr std::size_t kMostHeaderLines = 1000;  // eleven entries, the rest are comments
constexpr std::size_t kMostPoints = 4294967295; // PCL keeps widths and heights in 32 bits

constexpr std::string_view kEntries[] = {"VERSION", "FIELDS", "COLUMNS",   "SIZE",   "TYPE", "COUNT",
                                         "WIDTH",   "HEIGHT", "VIEWPOINT", "POINTS", "DATA"};

// What fettle itself reads is one number a point; others may have more (a descriptor).
constexpr std::string_view kScalars[] = {"x",   "y",     "z",     "normal_x", "normal_y", "normal_z",
                                         "rgb", "error", "sigma", "curve",    "role"};

bool is_entry(std::string_view word)
{
    return std::find(std::begin(kEntries), std::end(kEntries), word) != std::end(kEntries);
}

std::string_view comment_text(std::string_view line)
{
    line.remove_prefix(1); // '#'
    return line;
}

class HeaderParser {
  public:
    HeaderParser(std::string_view bytes, const std::string& source) : bytes_(bytes), source_(source), lines_(bytes) {}

    PcdHeader parse();

  private:
    using Words = std::vector<std::string_view>;

    [[noreturn]] void refuse(const std::string& problem) const
    {
        throw InputError(source_, lines_.place() + ": " + problem);
    }
    bool next_line();
    void read_entry(const Words& words);
    void read_comment(std::string_view text);
    void read_fields(const Words& words);
    void read_viewpoint(const Words& words);
    void read_data(const Words& words);
    std::size_t number(std::string_view word, const std::string& entry, std::size_t most) const;
    std::size_t only_number(const Words& words, std::size_t most) const;
    void check_count(const Words& words) const;
    void check_columns() const;
    void finish();

    std::string_view bytes_;
    const std::string& source_;
    Lines lines_;
    PcdHeader header_;
    std::set<std::string, std::less<>> seen_;
};

// The line must be ended and short before anybody looks at it.
bool HeaderParser::next_line()
{
    const std::string_view ahead = bytes_.substr(lines_.offset(), kLongestLine + 1);
    const std::size_t length = std::min(ahead.find('\n'), ahead.size());
    if (!lines_.next()) return false;
    if (length > kLongestLine) refuse("longer than " + std::to_string(kLongestLine) + " bytes, this is no PCD header");
    if (lines_.line().find('\0') != std::string_view::npos)
        refuse("zero byte in the header" + std::string(lines_.number() == 1 ? " (a mesh, or text in UTF-16?)" : ""));
    if (lines_.line().find('\r') != std::string_view::npos) refuse("carriage return without line feed");
    if (lines_.number() > kMostHeaderLines) refuse("no DATA within " + std::to_string(kMostHeaderLines) + " lines");
    return true;
}

std::size_t HeaderParser::number(std::string_view word, const std::string& entry, std::size_t most) const
{
    const std::optional<std::size_t> value = parse_whole<std::size_t>(word);
    if (!value) refuse(entry + ": expected a whole number, got " + in_quotes(word));
    if (*value > most) refuse(entry + ": at most " + std::to_string(most) + ", got " + in_quotes(word));
    return *value;
}

std::size_t HeaderParser::only_number(const Words& words, std::size_t most) const
{
    const std::string entry(words[0]);
    if (words.size() != 2) refuse(entry + ": expected one number, got " + std::to_string(words.size() - 1));
    return number(words[1], entry, most);
}

void HeaderParser::check_count(const Words& words) const
{
    if (words.size() - 1 != header_.columns.size())
        refuse(std::string(words[0]) + ": " + std::to_string(words.size() - 1) + " values for " +
               std::to_string(header_.columns.size()) + " fields");
}

void HeaderParser::read_comment(std::string_view text)
{
    std::optional<StatedUnits> units;
    try {
        units = parse_stated_units(text);
    } catch (const InputError& error) {
        refuse(error.what());
    }
    if (units && header_.units) refuse("second units comment");
    if (units) header_.units = units;
}

void HeaderParser::read_fields(const Words& words)
{
    if (words.size() == 1) refuse("FIELDS: no field");
    for (std::size_t i = 1; i < words.size(); ++i) header_.columns.emplace_back().name = std::string(words[i]);
}

void HeaderParser::read_viewpoint(const Words& words)
{
    constexpr std::size_t kNumbers = 7; // place and quaternion (w first)
    if (words.size() != kNumbers + 1) refuse("VIEWPOINT: expected 7 numbers, got " + std::to_string(words.size() - 1));
    double values[kNumbers];
    for (std::size_t i = 0; i < kNumbers; ++i) {
        const std::optional<double> value = parse_number(words[i + 1]);
        if (!value || !std::isfinite(*value))
            refuse("VIEWPOINT: expected a finite number, got " + in_quotes(words[i + 1]));
        values[i] = *value;
    }
    header_.view_origin = {values[0], values[1], values[2]};
    header_.view_orientation = Eigen::Quaterniond(values[3], values[4], values[5], values[6]);
    if (header_.view_orientation.coeffs().isZero(0)) refuse("VIEWPOINT: the quaternion is zero");
}

void HeaderParser::read_data(const Words& words)
{
    if (words.size() != 2) refuse("DATA: expected one word, got " + std::to_string(words.size() - 1));
    if (words[1] == "ascii")
        header_.data = PcdHeader::Data::ascii;
    else if (words[1] == "binary")
        header_.data = PcdHeader::Data::binary;
    else if (words[1] == "binary_compressed")
        header_.data = PcdHeader::Data::compressed;
    else
        refuse("DATA: " + in_quotes(words[1]) + " is none of ascii, binary, binary_compressed");
}

void HeaderParser::read_entry(const Words& words)
{
    const std::string entry(words[0] == "COLUMNS" ? "FIELDS" : words[0]); // as it was called before version 0.6
    if (!seen_.insert(entry).second) refuse(entry + " stands twice");
    if (entry != "VERSION" && entry != "FIELDS" && !seen_.contains("FIELDS")) refuse(entry + " before FIELDS");
    if (entry == "FIELDS") read_fields(words);
    if (entry == "SIZE" || entry == "TYPE" || entry == "COUNT") check_count(words);
    for (std::size_t i = 0; i < header_.columns.size(); ++i) {
        PcdColumn& column = header_.columns[i];
        if (entry == "SIZE") column.size = static_cast<int>(number(words[i + 1], entry, sizeof(double)));
        if (entry == "COUNT") column.count = static_cast<int>(number(words[i + 1], entry, kMostElements));
        if (entry == "COUNT" && column.count == 0)
            refuse("COUNT: at least 1, got 0 for field " + in_quotes(column.name));
        if (entry == "TYPE" && words[i + 1].size() != 1)
            refuse("TYPE: expected F, I or U, got " + in_quotes(words[i + 1]));
        if (entry == "TYPE") column.type = words[i + 1].front();
    }
    if (entry == "WIDTH") header_.width = only_number(words, kMostPoints);
    if (entry == "HEIGHT") header_.height = only_number(words, kMostPoints);
    if (entry == "POINTS") header_.points = only_number(words, kMostPoints);
    if (entry == "VIEWPOINT") read_viewpoint(words);
    if (entry == "DATA") read_data(words);
}

void HeaderParser::check_columns() const
{
    for (const std::string_view axis : {"x", "y", "z"}) {
        const auto is_axis = [axis](const PcdColumn& column) { return column.name == axis; };
        const auto found = std::find_if(header_.columns.begin(), header_.columns.end(), is_axis);
        if (found == header_.columns.end()) throw InputError(source_, "no field '" + std::string(axis) + "'");
    }
    for (const PcdColumn& column : header_.columns)
        if (column.count != 1 && std::find(std::begin(kScalars), std::end(kScalars), column.name) != std::end(kScalars))
            throw InputError(source_,
                             "field '" + column.name + "': COUNT " + std::to_string(column.count) + ", expected 1");
    std::set<std::string> names;
    for (const PcdColumn& column : header_.columns)
        if (column.name != "_" && !names.insert(column.name).second) // "_" is padding and may repeat
            throw InputError(source_, "field " + in_quotes(column.name) + " stands twice");
}

void HeaderParser::finish()
{
    for (const std::string_view needed : {"SIZE", "TYPE"})
        if (!seen_.contains(needed)) throw InputError(source_, "header without " + std::string(needed));
    if (!seen_.contains("WIDTH") && !seen_.contains("POINTS"))
        throw InputError(source_, "header without WIDTH or POINTS");
    for (const PcdColumn& column : header_.columns)
        if (!is_element_type(column.type, static_cast<std::size_t>(column.size)))
            throw InputError(source_, "field " + in_quotes(column.name) + ": no type " +
                                          in_quotes(element_name(column.type, column.size)) +
                                          " (F4, F8, I1, I2, I4, I8, U1, U2, U4, U8)");
    check_columns();
    PcdHeader& h = header_;
    if (!seen_.contains("WIDTH")) h.width = h.points;
    const std::size_t product = h.width * h.height; // both fit 32 bits
    if (!seen_.contains("POINTS")) h.points = product;
    if (product != h.points)
        throw InputError(source_, "WIDTH " + std::to_string(h.width) + " times HEIGHT " + std::to_string(h.height) +
                                      " is not POINTS " + std::to_string(h.points));
    if (h.points > 0 && h.stride() > std::numeric_limits<std::size_t>::max() / h.points)
        throw InputError(source_, "POINTS " + std::to_string(h.points) + " of " + std::to_string(h.stride()) +
                                      " bytes are more than any file holds");
    h.body = lines_.offset();
    h.lines = lines_.number();
}

PcdHeader HeaderParser::parse()
{
    while (next_line()) {
        const std::string_view line = lines_.line();
        if (line.starts_with('#')) {
            read_comment(comment_text(line));
            continue;
        }
        const Words found = words(line);
        if (found.empty()) continue;
        if (!is_entry(found[0])) refuse("expected a PCD header entry, got " + in_quotes(found[0]));
        read_entry(found);
        if (found[0] == "DATA") {
            finish();
            return header_;
        }
    }
    throw InputError(source_, "the header ends without DATA");
}

} // namespace

std::size_t PcdHeader::stride() const
{
    std::size_t sum = 0;
    for (const PcdColumn& column : columns) sum += column.bytes();
    return sum;
}

std::size_t PcdHeader::values_per_row() const
{
    std::size_t sum = 0;
    for (const PcdColumn& column : columns) sum += static_cast<std::size_t>(column.count);
    return sum;
}

void check_names(const std::vector<Field>& fields, const std::string& source)
{
    std::size_t length = std::string_view("FIELDS x y z").size();
    for (const Field& field : fields) {
        const auto is_control = [](char c) { return static_cast<unsigned char>(c) < ' '; };
        if (field.name == "x" || field.name == "y" || field.name == "z" ||
            std::any_of(field.name.begin(), field.name.end(), is_control))
            throw InputError(source, "no field can be called " + in_quotes(field.name));
        length += 1 + field.name.size();
    }
    if (length > kLongestLine)
        throw InputError(source, "the names of the fields take " + std::to_string(length) + " bytes, at most " +
                                     std::to_string(kLongestLine));
}

PcdHeader parse_pcd_header(std::string_view bytes, const std::string& source)
{
    return HeaderParser(bytes, source).parse();
}

void check_binary_size(const PcdHeader& header, std::size_t size, std::string_view next, const std::string& source)
{
    const std::size_t needed = header.points * header.stride();
    if (size == needed) return;
    throw InputError(source, "POINTS " + std::to_string(header.points) + " need " + std::to_string(needed) +
                                 " bytes, there are " + std::to_string(size) +
                                 (size > needed && looks_like_pcd(next) ? ": another PCD follows" : ""));
}

bool looks_like_pcd(std::string_view bytes)
{
    if (bytes.starts_with("# .PCD")) return true;
    Lines lines(bytes.substr(0, kLongestLine)); // enough for any comment before the first entry
    while (lines.next()) {
        std::string_view line = lines.line();
        if (!line.starts_with('#') && line.find_first_not_of(" \t") != std::string_view::npos)
            return is_entry(next_word(line));
    }
    return false;
}

} // namespace fettle
