#include "cloud/cloud_writer.h"

#include "cloud/cloud_encoder.h"
#include "cloud/pcd.h"

#include <ostream>

namespace fettle::cloud {

namespace {

class PcdEncoder : public CloudWriter::Encoder {
  public:
    PcdEncoder(std::ostream& out, PcdEncoding encoding, const units::Units& units, std::size_t points)
        : out_(out), encoding_(encoding), units_(units), points_(points)
    {
    }
    void begin(const Cloud& first) override { write_pcd_header(out_, first, points_, units_, encoding_); }
    void write(const Cloud& part) override { write_pcd_points(out_, part, units_, encoding_); }

  private:
    std::ostream& out_;
    PcdEncoding encoding_;
    units::Units units_;
    std::size_t points_;
};

class CsvEncoder : public CloudWriter::Encoder {
  public:
    CsvEncoder(std::ostream& out, const units::Units& units) : out_(out), units_(units) {}

    void begin(const Cloud& first) override
    {
        out_ << "x,y,z";
        for (const Field& field : first.fields)
            for (const std::string& name : element_names(field)) out_ << ',' << name;
        out_ << '\n';
    }

    void write(const Cloud& part) override
    {
        // A colour is an integer, 0x00RRGGBB, which as a float may be NaN.
        out_ << text_rows(to_file_coordinates(part, units_), to_file_units(part.fields, units_), ',',
                          [](const Field& field) { return is_colour(field) ? 'U' : field.type; });
    }

  private:
    std::ostream& out_;
    units::Units units_;
};

std::unique_ptr<CloudWriter::Encoder> make_encoder(std::ostream& out, CloudFormat format, const units::Units& units,
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

CloudWriter::CloudWriter(std::ostream& out, CloudFormat format, const units::Units& units, std::size_t points)
    : encoder_(make_encoder(out, format, units, points))
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

} // namespace fettle::cloud
