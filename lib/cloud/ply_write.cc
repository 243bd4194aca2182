#include "cloud/cloud_encoder.h"
#include "cloud/element.h"
#include "cloud/fields.h"

#include <cstring>
#include <functional>
#include <ostream>

namespace fettle {

namespace {

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

} // namespace

std::unique_ptr<CloudWriter::Encoder> ply_encoder(std::ostream& out, const Units& units, std::size_t points)
{
    return std::make_unique<PlyEncoder>(out, units, points);
}

} // namespace fettle
