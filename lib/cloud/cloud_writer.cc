#include "cloud/cloud_writer.h"

#include "cloud/cloud_encoder.h"
#include "cloud/element.h"
#include "cloud/pcd.h"
#include "core/text.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <functional>
#include <ostream>
#include <vector>

namespace fettle {

namespace {

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

std::unique_ptr<CloudWriter::Encoder> encoder_of(std::ostream& out, CloudFormat format, const Units& units,
                                                 std::size_t points)
{
    switch (format) {
    case CloudFormat::ply:
        return ply_encoder(out, units, points);
    case CloudFormat::csv:
        return std::make_unique<CsvEncoder>(out, units);
    case CloudFormat::vtk:
        return vtk_encoder(out, units, points);
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
