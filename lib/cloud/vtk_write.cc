#include "cloud/cloud_encoder.h"
#include "core/spool.h"

#include <algorithm>
#include <ostream>

namespace fettle {

namespace {

std::size_t bytes_of(const Field& field)
{
    return static_cast<std::size_t>(field.size) * static_cast<std::size_t>(field.count);
}

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

} // namespace

std::unique_ptr<CloudWriter::Encoder> vtk_encoder(std::ostream& out, const Units& units, std::size_t points)
{
    return std::make_unique<VtkEncoder>(out, units, points);
}

} // namespace fettle
