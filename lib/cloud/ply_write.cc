#include "cloud/cloud_encoder.h"
#include "cloud/element.h"
#include "cloud/fields.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <functional>
#include <ostream>
#include <type_traits>

namespace fettle {

namespace {

/// Elements of a field of points that follow each other, and where they go: `stride` bytes apart.
struct Copy {
    const std::byte* from; ///< the first point's
    std::size_t points;
    char* to;
    std::size_t stride;
};

/// A value of a point, as a binary PLY file has it: taken from a field's bytes, maybe made another type.
struct Property {
    std::string name;
    std::string type; ///< as PLY calls it
    std::size_t size; ///< bytes in the file
    std::function<void(const Copy&)> put;
};

/// The k-th element of each point, as it is or, of 64-bit whole numbers, which PLY has not, as double.
std::function<void(const Copy&)> copier(const Field& field, std::size_t k)
{
    const auto size = static_cast<std::size_t>(field.size), step = size * static_cast<std::size_t>(field.count);
    return visit_element(field.type, field.size, [&](auto zero) -> std::function<void(const Copy&)> {
        using T = decltype(zero);
        using Written = std::conditional_t<std::is_integral_v<T> && sizeof(T) == 8, double, T>;
        return [=](const Copy& copy) {
            const std::byte* from = copy.from + k * size;
            char* to = copy.to;
            for (std::size_t i = 0; i < copy.points; ++i, from += step, to += copy.stride)
                store(to, static_cast<Written>(load<T>(from)));
        };
    });
}

Property property_of(const Field& field, const std::string& name, std::size_t k)
{
    const bool wide = field.type != 'F' && field.size == 8;
    const std::string whole[] = {"char", "uchar", "short", "ushort", "int", "uint"};
    const std::size_t rank = field.size == 1 ? 0 : field.size == 2 ? 2 : 4;
    const std::string type = wide || (field.type == 'F' && field.size == 8) ? "double"
                             : field.type == 'F'                            ? "float"
                                                                            : whole[rank + (field.type == 'U' ? 1 : 0)];
    return {name, type, static_cast<std::size_t>(field.size), copier(field, k)};
}

/// A byte of a colour 0x00RRGGBB.
Property channel(const std::string& name, int shift)
{
    return {name, "uchar", 1, [shift](const Copy& copy) {
                char* to = copy.to;
                for (std::size_t i = 0; i < copy.points; ++i, to += copy.stride)
                    *to = static_cast<char>(load<std::uint32_t>(copy.from + 4 * i) >> shift);
            }};
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
                properties = {channel("red", 16), channel("green", 8), channel("blue", 0)};
            } else {
                for (const std::string& name : element_names(field))
                    properties.push_back(property_of(field, ply_name(name), properties.size()));
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
        constexpr std::size_t kChunk = 1 << 12; // points: what they take stays in the cache
        const auto points = static_cast<std::size_t>(part.size());
        std::vector<char> records(std::min(kChunk, points) * stride_);
        for (std::size_t first = 0; first < points; first += kChunk) {
            const std::size_t count = std::min(kChunk, points - first);
            char* to = records.data();
            for (std::size_t i = 0; i < count; ++i)
                std::memcpy(to + i * stride_, xyz.col(static_cast<Eigen::Index>(first + i)).data(), sizeof(float) * 3);
            to += sizeof(float) * 3;
            for (std::size_t f = 0; f < fields.size(); ++f) {
                const std::byte* const from = fields[f].bytes.data() + first * (fields[f].bytes.size() / points);
                for (const Property& property : properties_[f]) {
                    property.put({from, count, to, stride_});
                    to += property.size;
                }
            }
            out_.write(records.data(), static_cast<std::streamsize>(count * stride_));
        }
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

} // namespace

std::unique_ptr<CloudWriter::Encoder> ply_encoder(std::ostream& out, const Units& units, std::size_t points)
{
    return std::make_unique<PlyEncoder>(out, units, points);
}

} // namespace fettle
