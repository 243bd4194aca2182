#include "cloud/cloud_encoder.h"
#include "core/spool.h"

#include <algorithm>
#include <ostream>

namespace fettle::cloud {

namespace {

/// Converts `count` elements of `size` bytes to big-endian.
std::string big_endian(const char* bytes, std::size_t size, std::size_t count)
{
    std::string text(bytes, size * count);
    for (std::size_t i = 0; i < count; ++i) std::reverse(&text[i * size], &text[i * size] + size);
    return text;
}

/// VTK has all coordinates first and then field after field; so the fields are buffered until the end.
class VtkEncoder : public CloudWriter::Encoder {
  public:
    VtkEncoder(std::ostream& out, const units::Units& units, std::size_t points)
        : out_(out), units_(units), points_(points)
    {
    }

    void begin(const Cloud& first) override
    {
        out_ << "# vtk DataFile Version 3.0\npoints, units " << units::to_string(units_.length)
             << "\nBINARY\nDATASET POLYDATA\nPOINTS " << points_ << " float\n";
        for (const Field& field : to_file_units(slice(first, 0, 0).fields, units_))
            fields_.push_back({field, core::Spool(kMaxMemoryBytes)});
    }

    void write(const Cloud& part) override
    {
        const Eigen::Matrix3Xf xyz = to_file_coordinates(part, units_);
        out_ << big_endian(reinterpret_cast<const char*>(xyz.data()), sizeof(float), xyz.size());
        const std::vector<Field> fields = to_file_units(part.fields, units_);
        for (std::size_t f = 0; f < fields.size(); ++f)
            fields_[f].bytes.append({reinterpret_cast<const char*>(fields[f].bytes.data()), fields[f].bytes.size()});
    }

    void finish() override
    {
        out_ << "\nVERTICES " << points_ << ' ' << 2 * points_ << '\n';
        for (std::size_t first = 0; first < points_; first += kBlockPoints) {
            std::vector<std::uint32_t> cells;
            for (std::size_t i = first; i < std::min(first + kBlockPoints, points_); ++i)
                cells.insert(cells.end(), {1, static_cast<std::uint32_t>(i)});
            out_ << big_endian(reinterpret_cast<const char*>(cells.data()), 4, cells.size());
        }
        out_ << "\nPOINT_DATA " << points_ << '\n';
        // `error` comes first because ParaView colours by the first scalars.
        std::stable_partition(fields_.begin(), fields_.end(),
                              [](const Column& column) { return column.field.name == "error"; });
        for (const Column& column : fields_)
            if (!is_normal(column.field)) write_field(column);
        write_normals();
    }

  private:
    static constexpr std::size_t kMaxMemoryBytes = 1 << 26; // per field: 16 million floats
    static constexpr std::size_t kBlockPoints = 1 << 16;    // written at once

    struct Column {
        Field field;       ///< without points
        core::Spool bytes; ///< of all points
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

    /// Calls `use` with the bytes of consecutive points and their number, block by block.
    template <typename Use>
    void for_each_block(const Column& column, const Use& use) const
    {
        const std::size_t size = column.field.stride();
        std::string block;
        for (std::size_t first = 0; first < points_; first += kBlockPoints) {
            const std::size_t count = std::min(kBlockPoints, points_ - first);
            block.resize(count * size);
            column.bytes.read(first * size, block.data(), block.size());
            use(block, count);
        }
    }

    void write_field(const Column& column)
    {
        const Field& field = column.field;
        if (is_colour(field)) {
            out_ << "COLOR_SCALARS rgb 3\n";
            for_each_block(column, [&](const std::string& block, std::size_t count) {
                std::string rgb;
                for (std::size_t i = 0; i < count; ++i) rgb.append({block[4 * i + 2], block[4 * i + 1], block[4 * i]});
                out_ << rgb;
            });
        } else {
            out_ << "SCALARS " << field.name << ' ' << vtk_type(field) << ' ' << field.count
                 << "\nLOOKUP_TABLE default\n";
            for_each_block(column, [&](const std::string& block, std::size_t count) {
                out_ << big_endian(block.data(), field.size, count * field.count);
            });
        }
        out_ << '\n';
    }

    void write_normals()
    {
        const Column* axes[3] = {};
        for (const Column& column : fields_)
            if (is_normal(column.field) && column.field.type == 'F' && column.field.size == 4)
                axes[std::clamp(column.field.name.back() - 'x', 0, 2)] = &column;
        if (std::ranges::find(axes, nullptr) != std::end(axes)) return;
        out_ << "NORMALS normal float\n";
        for (std::size_t first = 0; first < points_; first += kBlockPoints) {
            const std::size_t count = std::min(kBlockPoints, points_ - first);
            Eigen::Matrix<float, Eigen::Dynamic, 3> normals(count, 3);
            for (int axis = 0; axis < 3; ++axis)
                axes[axis]->bytes.read(first * 4, reinterpret_cast<char*>(normals.col(axis).data()), 4 * count);
            const Eigen::Matrix3Xf columns = normals.transpose();
            out_ << big_endian(reinterpret_cast<const char*>(columns.data()), 4, 3 * count);
        }
        out_ << '\n';
    }

    std::ostream& out_;
    units::Units units_;
    std::size_t points_;
    std::vector<Column> fields_;
};

} // namespace

std::unique_ptr<CloudWriter::Encoder> vtk_encoder(std::ostream& out, const units::Units& units, std::size_t points)
{
    return std::make_unique<VtkEncoder>(out, units, points);
}

} // namespace fettle::cloud
