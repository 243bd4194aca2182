#pragma once

#include "cloud/cloud_writer.h"

#include <iosfwd>
#include <memory>
#include <string>
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

std::unique_ptr<CloudWriter::Encoder> ply_encoder(std::ostream& out, const Units& units, std::size_t points);
std::unique_ptr<CloudWriter::Encoder> vtk_encoder(std::ostream& out, const Units& units, std::size_t points);

/// Does a field hold colours as PCL packs them, 0x00RRGGBB?
bool is_colour(const Field& field);

/// The fields in the units of the file.
std::vector<Field> converted(const Cloud& part, const Units& units);

/// x y z as every format has them.
Eigen::Matrix3Xf places(const Cloud& part, const Units& units);

/// The names of a field's elements: NAME, or NAME_0, NAME_1, … if there are several a point.
std::vector<std::string> element_names(const Field& field);

} // namespace fettle
