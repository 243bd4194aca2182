#include "cloud/cloud_writer.h"

#include "cloud/element.h"
#include "cloud/fields.h"
#include "cloud/pcd.h"
#include "core/spool.h"
#include "core/text.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <functional>
#include <ostream>
#include <vector>

namespace fettle {

/// Does the work of one format.
struct CloudWriter::Encoder {
    virtual ~Encoder() = default;
    virtual void begin(const Cloud& first) = 0;
    virtual void write(const Cloud& part) = 0;
    virtual void finish() {}

    bool begun = false;
};

namespace {

bool is_colour(const Field& field) { return field.name == "rgb" && field.size == 4 && field.count == 1; }

/// The fields in the units of the file.
std::vector<Field> converted(const Cloud& part, const Units& units)
{
    std::vector<Field> fields = part.fields;
    for (Field& field : fields)
        if (const double factor = to_base(units, field_dimension(field.name)); factor != 1) scale(field, 1, factor);
    return fields;
}

Eigen::Matrix3Xf places(const Cloud& part, const Units& units) { return (part.xyz / units.mm()).cast<float>(); }

/// The names of a field's elements: NAME, or NAME_0, NAME_1, … if there are several a point.
std::vector<std::string> element_names(const Field& field)
{
    if (field.count == 1) return {field.name};
    std::vector<std::string> names;
    for (int k = 0; k < field.count; ++k) names.push_back(field.name + '_' + std::to_string(k));
    return names;
}

std::size_t bytes_of(const Field& field)
{
    return static_cast<std::size_t>(field.size) * static_cast<std::size_t>(field.count);
}

class PcdEncoder : public CloudWriter::Encoder {
  public:
    PcdEncoder(std::ostream& out, PcdEncoding encoding, const Units& units, std::size_t points)
        : out_(out), encoding_(encoding), units_(units), points_(points)
    {
    }
    void begin(const Cloud& first) override { write_pcd_header(out_, first, points_, units_, encoding_); }
    void write(const Cloud& part) override { write_pcd_points(out_, part, units_, encoding_); }

  private:
    std::ostream& out_;
    PcdEncoding encoding_;
    Units units_;
    std::size_t points_;
};

class CsvEncoder : public CloudWriter::Encoder {
  public:
    CsvEncoder(std::ostream& out, const Units& units) : out_(out), units_(units) {}

    void begin(const Cloud& first) override
    {
        out_ << "x,y,z";
        for (const Field& field : first.fields)
            for (const std::string& name : element_names(field)) out_ << ',' << name;
        out_ << '\n';
    }

    void write(const Cloud& part) override
    {
        const std::vector<Field> fields = converted(part, units_);
        const Eigen::Matrix3Xf xyz = places(part, units_);
        std::string text;
        for (Eigen::Index i = 0; i < part.size(); ++i) {
            for (int axis = 0; axis < 3; ++axis) text += (axis > 0 ? "," : "") + to_text(xyz(axis, i));
            for (const Field& field : fields)
                for (int k = 0; k < field.count; ++k) {
                    text += ',';
                    append(text, field,
                           static_cast<std::size_t>(i) * static_cast<std::size_t>(field.count) +
                               static_cast<std::size_t>(k));
                }
            text += '\n';
        }
        out_ << text;
    }

  private:
    static void append(std::string& text, const Field& field, std::size_t index)
    {
        const char type = is_colour(field) ? 'U' : field.type; // 0x00RRGGBB, which as a float may be NaN
        visit_element(type, field.size, [&](auto zero) {
            const auto value = load<decltype(zero)>(field.bytes.data() + index * sizeof zero);
            if constexpr (std::is_floating_point_v<decltype(value)>) {
                text += to_text(value);
            } else {
                char digits[24]; // of 64 bits, with a sign
                text.append(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
            }
        });
    }

    std::ostream& out_;
    Units units_;
};

/// A value of a point, as a binary PLY or VTK file has it: taken from a field's bytes, maybe made another type.
struct Property {
    std::string name;
    std::string type; ///< as PLY calls it
    std::size_t size; ///< bytes in the file
    std::function<void(const Field& field, std::size_t index, char* to)> put;
    bool plain = false; ///< four bytes as they are
};

// 64-bit whole numbers, which PLY has not, become doubles.
Property property_of(const Field& field, const std::string& name)
{
    const bool wide = field.type != 'F' && field.size == 8;
    const std::string whole[] = {"char", "uchar", "short", "ushort", "int", "uint"};
    const std::size_t rank = field.size == 1 ? 0 : field.size == 2 ? 2 : 4;
    const std::string type = wide || (field.type == 'F' && field.size == 8) ? "double"
                             : field.type == 'F'                            ? "float"
                                                                            : whole[rank + (field.type == 'U' ? 1 : 0)];
    return {name, type, static_cast<std::size_t>(field.size),
            [wide](const Field& f, std::size_t index, char* to) {
                const auto size = static_cast<std::size_t>(f.size);
                if (wide)
                    store(to, element(f, f.type, index));
                else
                    std::memcpy(to, f.bytes.data() + index * size, size);
            },
            field.size == 4 && field.count == 1};
}

class PlyEncoder : public CloudWriter::Encoder {
  public:
    PlyEncoder(std::ostream& out, const Units& units, std::size_t points) : out_(out), units_(units), points_(points) {}

    void begin(const Cloud& first) override
    {
        out_ << "ply\nformat binary_little_endian 1.0\ncomment units " << to_string(units_.length)
             << "\nelement vertex " << points_ << "\nproperty float x\nproperty float y\nproperty float z\n";
        for (const Field& field : converted(part(first, 0, 0), units_)) {
            std::vector<Property>& properties = properties_.emplace_back();
            if (is_colour(field)) {
                for (const int shift : {16, 8, 0})
                    properties.push_back({shift == 16  ? "red"
                                          : shift == 8 ? "green"
                                                       : "blue",
                                          "uchar", 1, [shift](const Field& f, std::size_t index, char* to) {
                                              store(to, static_cast<std::uint8_t>(
                                                            load<std::uint32_t>(f.bytes.data() + 4 * index) >> shift));
                                          }});
            } else {
                for (const std::string& name : element_names(field))
                    properties.push_back(property_of(field, ply_name(name)));
            }
            for (const Property& property : properties) {
                out_ << "property " << property.type << ' ' << property.name << '\n';
                stride_ += property.size;
            }
        }
        out_ << "end_header\n";
    }

    void write(const Cloud& part) override
    {
        const std::vector<Field> fields = converted(part, units_);
        const Eigen::Matrix3Xf xyz = places(part, units_);
        std::string records(static_cast<std::size_t>(part.size()) * stride_, '\0');
        for (std::size_t i = 0; i < static_cast<std::size_t>(part.size()); ++i)
            std::memcpy(&records[i * stride_], xyz.col(static_cast<Eigen::Index>(i)).data(), sizeof(float) * 3);
        std::size_t offset = sizeof(float) * 3;
        for (std::size_t f = 0; f < fields.size(); ++f) {
            const std::vector<Property>& properties = properties_[f];
            const std::size_t step = fields[f].count > 1 ? properties.size() : 1;
            for (std::size_t k = 0; k < properties.size(); ++k) {
                char* to = records.data() + offset;
                for (std::size_t i = 0; i < static_cast<std::size_t>(part.size()); ++i, to += stride_)
                    if (properties[k].plain) // nearly always
                        std::memcpy(to, fields[f].bytes.data() + 4 * i, 4);
                    else
                        properties[k].put(fields[f], i * step + (step > 1 ? k : 0), to);
                offset += properties[k].size;
            }
        }
        out_ << records;
    }

  private:
    static std::string ply_name(const std::string& name)
    {
        if (name == "normal_x" || name == "normal_y" || name == "normal_z") return std::string("n") + name.back();
        return "scalar_" + name;
    }

    std::ostream& out_;
    Units units_;
    std::size_t points_;
    std::size_t stride_ = sizeof(float) * 3;
    std::vector<std::vector<Property>> properties_; ///< of each field
};

/// Big-endian bytes of the elements of a field.
std::string big_endian(const char* bytes, std::size_t size, std::size_t count)
{
    std::string text(bytes, size * count);
    for (std::size_t i = 0; i < count; ++i) std::reverse(&text[i * size], &text[i * size] + size);
    return text;
}

/// Points first, then each field: what comes in parts is put by until the end.
class VtkEncoder : public CloudWriter::Encoder {
  public:
    VtkEncoder(std::ostream& out, const Units& units, std::size_t points) : out_(out), units_(units), points_(points) {}

    void begin(const Cloud& first) override
    {
        out_ << "# vtk DataFile Version 3.0\npoints, units " << to_string(units_.length)
             << "\nBINARY\nDATASET POLYDATA\nPOINTS " << points_ << " float\n";
        for (const Field& field : converted(part(first, 0, 0), units_)) fields_.push_back({field, Spool(kHeld)});
    }

    void write(const Cloud& part) override
    {
        const Eigen::Matrix3Xf xyz = places(part, units_);
        out_ << big_endian(reinterpret_cast<const char*>(xyz.data()), sizeof(float),
                           static_cast<std::size_t>(xyz.size()));
        const std::vector<Field> fields = converted(part, units_);
        for (std::size_t f = 0; f < fields.size(); ++f)
            fields_[f].bytes.append({reinterpret_cast<const char*>(fields[f].bytes.data()), fields[f].bytes.size()});
    }

    void finish() override
    {
        out_ << "\nVERTICES " << points_ << ' ' << 2 * points_ << '\n';
        constexpr std::size_t kBlock = 1 << 16;
        for (std::size_t first = 0; first < points_; first += kBlock) {
            std::vector<std::uint32_t> cells;
            for (std::size_t i = first; i < std::min(first + kBlock, points_); ++i)
                cells.insert(cells.end(), {1, static_cast<std::uint32_t>(i)});
            out_ << big_endian(reinterpret_cast<const char*>(cells.data()), 4, cells.size());
        }
        out_ << "\nPOINT_DATA " << points_ << '\n';
        // The error is first: ParaView colours by the first scalars it finds.
        std::stable_partition(fields_.begin(), fields_.end(), [](const Kept& k) { return k.field.name == "error"; });
        for (const Kept& kept : fields_)
            if (!is_normal(kept.field)) write_field(kept);
        write_normals();
    }

  private:
    static constexpr std::size_t kHeld = 1 << 26; // bytes of a field in memory: 16 million points

    struct Kept {
        Field field; ///< without points
        Spool bytes;
    };

    static bool is_normal(const Field& field) { return field.name.starts_with("normal_") && field.count == 1; }

    static std::string vtk_type(const Field& field)
    {
        if (field.type == 'F') return field.size == 4 ? "float" : "double";
        const std::string name = field.size == 1   ? "char"
                                 : field.size == 2 ? "short"
                                 : field.size == 4 ? "int"
                                                   : "long";
        return (field.type == 'U' ? "unsigned_" : "") + name;
    }

    /// Calls `use` with the bytes of some points and their number.
    template <typename Use>
    void in_blocks(const Kept& kept, const Use& use) const
    {
        constexpr std::size_t kBlock = 1 << 16;
        const std::size_t size = bytes_of(kept.field);
        std::string block;
        for (std::size_t first = 0; first < points_; first += kBlock) {
            const std::size_t count = std::min(kBlock, points_ - first);
            block.resize(count * size);
            kept.bytes.read(first * size, block.data(), block.size());
            use(block, count);
        }
    }

    void write_field(const Kept& kept)
    {
        const Field& field = kept.field;
        if (is_colour(field)) {
            out_ << "COLOR_SCALARS rgb 3\n";
            in_blocks(kept, [&](const std::string& block, std::size_t count) {
                std::string rgb;
                for (std::size_t i = 0; i < count; ++i) rgb.append({block[4 * i + 2], block[4 * i + 1], block[4 * i]});
                out_ << rgb;
            });
        } else {
            out_ << "SCALARS " << field.name << ' ' << vtk_type(field) << ' ' << field.count
                 << "\nLOOKUP_TABLE default\n";
            in_blocks(kept, [&](const std::string& block, std::size_t count) {
                out_ << big_endian(block.data(), static_cast<std::size_t>(field.size),
                                   count * static_cast<std::size_t>(field.count));
            });
        }
        out_ << '\n';
    }

    void write_normals()
    {
        const Kept* axes[3] = {};
        for (const Kept& kept : fields_)
            if (is_normal(kept.field) && kept.field.type == 'F' && kept.field.size == 4)
                axes[std::clamp(kept.field.name.back() - 'x', 0, 2)] = &kept;
        if (std::find(std::begin(axes), std::end(axes), nullptr) != std::end(axes)) return;
        out_ << "NORMALS normal float\n";
        constexpr std::size_t kBlock = 1 << 16;
        for (std::size_t first = 0; first < points_; first += kBlock) {
            const std::size_t count = std::min(kBlock, points_ - first);
            Eigen::Matrix<float, Eigen::Dynamic, 3> normals(static_cast<Eigen::Index>(count), 3);
            for (int axis = 0; axis < 3; ++axis)
                axes[axis]->bytes.read(first * 4, reinterpret_cast<char*>(normals.col(axis).data()), 4 * count);
            const Eigen::Matrix3Xf columns = normals.transpose();
            out_ << big_endian(reinterpret_cast<const char*>(columns.data()), 4, 3 * count);
        }
        out_ << '\n';
    }

    std::ostream& out_;
    Units units_;
    std::size_t points_;
    std::vector<Kept> fields_;
};

std::unique_ptr<CloudWriter::Encoder> encoder_of(std::ostream& out, CloudFormat format, const Units& units,
                                                 std::size_t points)
{
    switch (format) {
    case CloudFormat::ply:
        return std::make_unique<PlyEncoder>(out, units, points);
    case CloudFormat::csv:
        return std::make_unique<CsvEncoder>(out, units);
    case CloudFormat::vtk:
        return std::make_unique<VtkEncoder>(out, units, points);
    case CloudFormat::pcd_ascii:
        return std::make_unique<PcdEncoder>(out, PcdEncoding::ascii, units, points);
    case CloudFormat::pcd:
        break;
    }
    return std::make_unique<PcdEncoder>(out, PcdEncoding::binary, units, points);
}

} // namespace

CloudWriter::CloudWriter(std::ostream& out, CloudFormat format, const Units& units, std::size_t points)
    : encoder_(encoder_of(out, format, units, points))
{
}
CloudWriter::~CloudWriter() = default;

void CloudWriter::write(const Cloud& part)
{
    if (!encoder_->begun) encoder_->begin(part);
    encoder_->begun = true;
    encoder_->write(part);
}

void CloudWriter::finish() { encoder_->finish(); }

} // namespace fettle
