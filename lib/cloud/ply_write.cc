#include "cloud/cloud_encoder.h"
#include "cloud/element.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <functional>
#include <ostream>
#include <type_traits>

namespace fettle::cloud {

namespace {

/// Task to copy one value of consecutive points.
struct Copy {
    const std::byte* from; ///< the field of the first point
    std::size_t points;
    char* to;           ///< the property of the first point
    std::size_t stride; ///< bytes between properties of consecutive points
};

/// A property of the vertices in a binary PLY file.
struct WrittenProperty {
    std::string name;
    std::string type; ///< PLY's name of it
    std::size_t size; ///< bytes in the file
    std::function<void(const Copy&)> copy;
};

/// Copies the k-th element of each point. PLY lacks 64-bit integers; they become doubles.
std::function<void(const Copy&)> element_copier(const Field& field, std::size_t k)
{
    const std::size_t size = field.size, step = field.stride();
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

WrittenProperty property_of(const Field& field, const std::string& name, std::size_t k)
{
    const std::string integer = field.size == 1 ? "char" : field.size == 2 ? "short" : "int";
    const std::string type = field.size == 8     ? "double"
                             : field.type == 'F' ? "float"
                                                 : (field.type == 'U' ? "u" : "") + integer;
    return {name, type, static_cast<std::size_t>(field.size), element_copier(field, k)};
}

/// One channel of a colour 0x00RRGGBB.
WrittenProperty channel(const std::string& name, int shift)
{
    return {name, "uchar", 1, [shift](const Copy& copy) {
                char* to = copy.to;
                for (std::size_t i = 0; i < copy.points; ++i, to += copy.stride)
                    *to = static_cast<char>(load<std::uint32_t>(copy.from + 4 * i) >> shift);
            }};
}

class PlyEncoder : public CloudWriter::Encoder {
  public:
    PlyEncoder(std::ostream& out, const units::Units& units, std::size_t points, std::size_t faces)
        : out_(out), units_(units), points_(points), faces_(faces)
    {
    }

    void begin(const Cloud& first) override
    {
        out_ << "ply\nformat binary_little_endian 1.0\ncomment units " << units::to_string(units_.length)
             << (first.frame == Frame::job ? "\ncomment frame job" : "") << "\nelement vertex " << points_
             << "\nproperty float x\nproperty float y\nproperty float z\n";
        for (const Field& field : to_file_units(slice(first, 0, 0).fields, units_)) {
            std::vector<WrittenProperty>& properties = properties_.emplace_back();
            if (is_colour(field)) {
                properties = {channel("red", 16), channel("green", 8), channel("blue", 0)};
            } else {
                for (const std::string& name : element_names(field))
                    properties.push_back(property_of(field, ply_name(name), properties.size()));
            }
            for (const WrittenProperty& property : properties) {
                out_ << "property " << property.type << ' ' << property.name << '\n';
                stride_ += property.size;
            }
        }
        if (faces_ > 0) out_ << "element face " << faces_ << "\nproperty list uchar int vertex_indices\n";
        out_ << "end_header\n";
    }

    void write(const Cloud& part) override
    {
        const std::vector<Field> fields = to_file_units(part.fields, units_);
        const Eigen::Matrix3Xf xyz = to_file_coordinates(part, units_);
        constexpr std::size_t kBlockPoints = 1 << 12; // their bytes fit the processor's cache
        const std::size_t points = part.size();
        std::vector<char> records(std::min(kBlockPoints, points) * stride_);
        for (std::size_t first = 0; first < points; first += kBlockPoints) {
            const std::size_t count = std::min(kBlockPoints, points - first);
            char* to = records.data();
            for (std::size_t i = 0; i < count; ++i)
                std::memcpy(to + i * stride_, xyz.col(first + i).data(), sizeof(float) * 3);
            to += sizeof(float) * 3;
            for (std::size_t f = 0; f < fields.size(); ++f) {
                const std::byte* const from = fields[f].bytes.data() + first * fields[f].stride();
                for (const WrittenProperty& property : properties_[f]) {
                    property.copy({from, count, to, stride_});
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
    units::Units units_;
    std::size_t points_, faces_;
    std::size_t stride_ = sizeof(float) * 3;
    std::vector<std::vector<WrittenProperty>> properties_; ///< properties of each field
};

} // namespace

std::unique_ptr<CloudWriter::Encoder> ply_encoder(std::ostream& out, const units::Units& units, std::size_t points,
                                                  std::size_t faces)
{
    return std::make_unique<PlyEncoder>(out, units, points, faces);
}

void write_ply_faces(std::ostream& out, const Eigen::Matrix3Xi& triangles)
{
    constexpr std::size_t kCornerBytes = 3 * sizeof(std::int32_t), kFaceBytes = 1 + kCornerBytes;
    std::vector<char> bytes(kFaceBytes * static_cast<std::size_t>(triangles.cols()));
    char* to = bytes.data();
    for (Eigen::Index t = 0; t < triangles.cols(); ++t, to += kFaceBytes) {
        *to = 3;
        std::memcpy(to + 1, triangles.col(t).data(), kCornerBytes);
    }
    out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

} // namespace fettle::cloud
