#include "cloud/pcd_header.h"

#include "cloud/element.h"
#include "core/error.h"
#include "core/lines.h"
#include "core/text.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace fettle::cloud {

namespace {

// Limits that no real file reaches. They keep a malformed one from using much memory.
constexpr std::size_t kMaxPcdLineBytes = 1 << 16;  // PCL's histograms name at most a few hundred fields
constexpr std::size_t kMaxElements = 1 << 16;      // of one field; PCL's longest descriptor has 1344
constexpr std::string_view kStampWord = "checked"; // begins the comment of a checked path
constexpr std::size_t kMaxHeaderLines = 1000;      // eleven entries, the rest are comments
constexpr std::size_t kMaxPoints = 4294967295;     // PCL keeps widths and heights in 32 bits

constexpr std::string_view kEntries[] = {"VERSION", "FIELDS", "COLUMNS",   "SIZE",   "TYPE", "COUNT",
                                         "WIDTH",   "HEIGHT", "VIEWPOINT", "POINTS", "DATA"};

// Fields that fettle itself uses are scalars; others may have several elements, as descriptors do.
constexpr std::string_view kScalars[] = {"x",   "y",     "z",     "normal_x", "normal_y", "normal_z",
                                         "rgb", "error", "sigma", "curve",    "role"};

bool is_entry(std::string_view word) { return std::ranges::find(kEntries, word) != std::end(kEntries); }

class PcdHeaderParser : core::FileLines {
  public:
    using core::FileLines::FileLines;

    PcdHeader parse()
    {
        while (next_line()) {
            if (line().starts_with('#')) {
                read_comment(line().substr(1));
                continue;
            }
            const Words entry = core::words(line());
            if (entry.empty()) continue;
            if (!is_entry(entry[0])) refuse("expected a PCD header entry, got " + core::in_quotes(entry[0]));
            read_entry(entry);
            if (entry[0] == "DATA") {
                finish();
                return header_;
            }
        }
        throw core::InputError(source_, "the header ends without DATA");
    }

  private:
    using Words = std::vector<std::string_view>;

    bool next_line()
    {
        if (!next_short(kMaxPcdLineBytes)) return false;
        if (line().find('\0') != std::string_view::npos)
            refuse("zero byte in the header" + std::string(number() == 1 ? " (a mesh, or text in UTF-16?)" : ""));
        if (line().find('\r') != std::string_view::npos) refuse("carriage return without line feed");
        if (number() > kMaxHeaderLines) refuse("no DATA within " + std::to_string(kMaxHeaderLines) + " lines");
        return true;
    }

    std::size_t integer(std::string_view word, const std::string& entry, std::size_t max) const
    {
        const std::optional<std::size_t> value = core::parse_integer<std::size_t>(word);
        if (!value) refuse(entry + ": expected a whole number, got " + core::in_quotes(word));
        if (*value > max) refuse(entry + ": at most " + std::to_string(max) + ", got " + core::in_quotes(word));
        return *value;
    }

    std::size_t only_integer(const Words& words, std::size_t max) const
    {
        const std::string entry(words[0]);
        if (words.size() != 2) refuse(entry + ": expected one number, got " + std::to_string(words.size() - 1));
        return integer(words[1], entry, max);
    }

    void check_count(const Words& words) const
    {
        if (words.size() - 1 != header_.columns.size())
            refuse(std::string(words[0]) + ": " + std::to_string(words.size() - 1) + " values for " +
                   std::to_string(header_.columns.size()) + " fields");
    }

    void read_comment(std::string_view text)
    {
        if (is_job_frame_comment(text)) header_.frame = Frame::job;
        if (const Words parts = core::words(text); !parts.empty() && parts[0] == kStampWord)
            header_.stamp = text.substr(text.find(kStampWord));
        std::optional<DeclaredUnits> units;
        try {
            units = parse_units_comment(text);
        } catch (const core::InputError& error) {
            refuse(error.what());
        }
        if (units && header_.units) refuse("second units comment");
        if (units) header_.units = units;
    }

    void read_fields(const Words& words)
    {
        if (words.size() == 1) refuse("FIELDS: no field");
        for (std::size_t i = 1; i < words.size(); ++i) header_.columns.emplace_back().name = std::string(words[i]);
    }

    void read_viewpoint(const Words& words)
    {
        constexpr std::size_t kNumbers = 7; // position and quaternion (w first)
        if (words.size() != kNumbers + 1)
            refuse("VIEWPOINT: expected 7 numbers, got " + std::to_string(words.size() - 1));
        double values[kNumbers];
        for (std::size_t i = 0; i < kNumbers; ++i) {
            const std::optional<double> value = core::parse_number(words[i + 1]);
            if (!value || !std::isfinite(*value))
                refuse("VIEWPOINT: expected a finite number, got " + core::in_quotes(words[i + 1]));
            values[i] = *value;
        }
        header_.view_origin = {values[0], values[1], values[2]};
        header_.view_orientation = Eigen::Quaterniond(values[3], values[4], values[5], values[6]);
        if (header_.view_orientation.coeffs().isZero(0)) refuse("VIEWPOINT: the quaternion is zero");
    }

    void read_data(const Words& words)
    {
        if (words.size() != 2) refuse("DATA: expected one word, got " + std::to_string(words.size() - 1));
        if (words[1] == "ascii")
            header_.data = PcdHeader::Data::ascii;
        else if (words[1] == "binary")
            header_.data = PcdHeader::Data::binary;
        else if (words[1] == "binary_compressed")
            header_.data = PcdHeader::Data::compressed;
        else
            refuse("DATA: " + core::in_quotes(words[1]) + " is none of ascii, binary, binary_compressed");
    }

    void read_entry(const Words& words)
    {
        const std::string entry(words[0] == "COLUMNS" ? "FIELDS" : words[0]); // its name before version 0.6
        if (!seen_.insert(entry).second) refuse(entry + " is duplicated");
        if (entry != "VERSION" && entry != "FIELDS" && !seen_.contains("FIELDS")) refuse(entry + " before FIELDS");
        if (entry == "FIELDS") read_fields(words);
        if (entry == "SIZE" || entry == "TYPE" || entry == "COUNT") check_count(words);
        for (std::size_t i = 0; i < header_.columns.size(); ++i) {
            PcdColumn& column = header_.columns[i];
            if (entry == "SIZE") column.size = static_cast<int>(integer(words[i + 1], entry, sizeof(double)));
            if (entry == "COUNT") column.count = static_cast<int>(integer(words[i + 1], entry, kMaxElements));
            if (entry == "COUNT" && column.count == 0)
                refuse("COUNT: at least 1, got 0 for field " + core::in_quotes(column.name));
            if (entry == "TYPE" && words[i + 1].size() != 1)
                refuse("TYPE: expected F, I or U, got " + core::in_quotes(words[i + 1]));
            if (entry == "TYPE") column.type = words[i + 1].front();
        }
        if (entry == "WIDTH") header_.width = only_integer(words, kMaxPoints);
        if (entry == "HEIGHT") header_.height = only_integer(words, kMaxPoints);
        if (entry == "POINTS") header_.points = only_integer(words, kMaxPoints);
        if (entry == "VIEWPOINT") read_viewpoint(words);
        if (entry == "DATA") read_data(words);
    }

    void check_columns() const
    {
        const auto has = [&](std::string_view name) {
            return std::ranges::find(header_.columns, name, &PcdColumn::name) != header_.columns.end();
        };
        const bool is_joints = std::ranges::all_of(header_.columns, [](const PcdColumn& column) {
            return column.name.starts_with("joint") || column.name == "t";
        });
        for (const std::string_view axis : {"x", "y", "z"})
            if (!has(axis) && !is_joints) throw core::InputError(source_, "no field '" + std::string(axis) + "'");
        for (const PcdColumn& column : header_.columns)
            if (column.count != 1 && std::ranges::find(kScalars, column.name) != std::end(kScalars))
                throw core::InputError(source_, "field '" + column.name + "': COUNT " + std::to_string(column.count) +
                                                    ", expected 1");
        std::set<std::string> names;
        for (const PcdColumn& column : header_.columns)
            if (column.name != "_" && !names.insert(column.name).second) // "_" is padding and may be repeated
                throw core::InputError(source_, "field " + core::in_quotes(column.name) + " is duplicated");
    }

    void finish()
    {
        for (const std::string_view needed : {"SIZE", "TYPE"})
            if (!seen_.contains(needed)) throw core::InputError(source_, "header without " + std::string(needed));
        if (!seen_.contains("WIDTH") && !seen_.contains("POINTS"))
            throw core::InputError(source_, "header without WIDTH or POINTS");
        for (const PcdColumn& column : header_.columns)
            if (!is_element_type(column.type, column.size))
                throw core::InputError(source_, "field " + core::in_quotes(column.name) + ": no type " +
                                                    core::in_quotes(element_name(column.type, column.size)) +
                                                    " (F4, F8, I1, I2, I4, I8, U1, U2, U4, U8)");
        check_columns();
        PcdHeader& h = header_;
        if (!seen_.contains("WIDTH")) h.width = h.points;
        const std::size_t product = h.width * h.height; // no overflow: both fit 32 bits
        if (!seen_.contains("POINTS")) h.points = product;
        if (product != h.points)
            throw core::InputError(source_, "WIDTH " + std::to_string(h.width) + " times HEIGHT " +
                                                std::to_string(h.height) + " is not POINTS " +
                                                std::to_string(h.points));
        if (h.points > 0 && h.stride() > std::numeric_limits<std::size_t>::max() / h.points)
            throw core::InputError(source_, "POINTS " + std::to_string(h.points) + " of " + std::to_string(h.stride()) +
                                                " bytes are more than any file holds");
        h.body = offset();
        h.lines = number();
    }

    PcdHeader header_;
    std::set<std::string, std::less<>> seen_; ///< entries read so far
};

/// pcl::PCDWriter::writeBinary() makes a file as long as a page of memory and the points, whatever the length of its
/// header: it ends with as many zeros as the header is shorter than the page.
/// @param bytes  number of those after the last point   @param next  the first of them
bool is_pcl_padding(const PcdHeader& header, std::size_t bytes, std::string_view next)
{
    constexpr std::size_t kPageBytes[] = {std::size_t{1} << 12, std::size_t{1} << 14, std::size_t{1} << 16}; // of Linux
    return std::ranges::find(kPageBytes, header.body + bytes) != std::end(kPageBytes) && next.size() == bytes &&
           next.find_first_not_of('\0') == std::string_view::npos;
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
    for (const PcdColumn& column : columns) sum += column.count;
    return sum;
}

void check_field_names(const std::vector<Field>& fields, const std::string& source)
{
    std::size_t length = std::string_view("FIELDS x y z").size();
    for (const Field& field : fields) {
        const auto is_control = [](char c) { return static_cast<unsigned char>(c) < ' '; };
        if (field.name == "x" || field.name == "y" || field.name == "z" || std::ranges::any_of(field.name, is_control))
            throw core::InputError(source, "no field can be called " + core::in_quotes(field.name));
        length += 1 + field.name.size();
    }
    if (length > kMaxPcdLineBytes)
        throw core::InputError(source, "the names of the fields take " + std::to_string(length) + " bytes, at most " +
                                           std::to_string(kMaxPcdLineBytes));
}

PcdHeader parse_pcd_header(std::string_view bytes, const std::string& source)
{
    return PcdHeaderParser(bytes, source).parse();
}

void check_binary_size(const PcdHeader& header, std::size_t size, std::string_view next, const std::string& source)
{
    const std::size_t needed = header.points * header.stride();
    if (size == needed || (size > needed && is_pcl_padding(header, size - needed, next))) return;
    throw core::InputError(source, "POINTS " + std::to_string(header.points) + " need " + std::to_string(needed) +
                                       " bytes, there are " + std::to_string(size) +
                                       (size > needed && looks_like_pcd(next) ? ": another PCD follows" : ""));
}

bool looks_like_pcd(std::string_view bytes)
{
    if (bytes.starts_with("# .PCD")) return true;
    core::Lines lines(bytes.substr(0, kMaxPcdLineBytes)); // enough for all comments before the first entry
    while (lines.next()) {
        std::string_view line = lines.line();
        if (line.starts_with('#') || core::is_blank_line(line)) continue;
        const std::string_view word = core::next_word(line);
        return is_entry(word.substr(0, word.find('\0'))); // the parser will name the zero byte
    }
    return false;
}

} // namespace fettle::cloud
