#pragma once

#include "cloud/cloud_writer.h"
#include "cloud/fields.h"

#include <iosfwd>
#include <memory>
#include <string>
#include <vector>

namespace fettle::cloud {

/// Encodes one format.
struct CloudWriter::Encoder {
    virtual ~Encoder() = default;
    virtual void begin(const Cloud& first) = 0;
    virtual void write(const Cloud& part) = 0;
    virtual void finish() {}

    bool begun = false;
};

/// @param faces  that the header announces; write_ply_faces() writes them after the points
std::unique_ptr<CloudWriter::Encoder> ply_encoder(std::ostream& out, const units::Units& units, std::size_t points,
                                                  std::size_t faces = 0);
/// @param triangles  3xT, indices of points
void write_ply_faces(std::ostream& out, const Eigen::Matrix3Xi& triangles);
std::unique_ptr<CloudWriter::Encoder> vtk_encoder(std::ostream& out, const units::Units& units, std::size_t points);

/// True for a field of colours packed as in PCL, 0x00RRGGBB.
bool is_colour(const Field& field);

/// x y z in the units of the file, in the precision of all formats.
Eigen::Matrix3Xf to_file_coordinates(const Cloud& part, const units::Units& units);

/// Names of a field's elements: NAME, or NAME_0, NAME_1, … if there are several per point.
std::vector<std::string> element_names(const Field& field);

} // namespace fettle::cloud
