#pragma once

#include "cloud/cloud.h"
#include "units/units.h"

#include <cstddef>
#include <iosfwd>
#include <memory>
#include <string>

namespace fettle {

/// Formats of points. All carry every field; none but PCD says its units.
enum class CloudFormat {
    pcd,       ///< binary
    pcd_ascii, ///< PCD as text
    ply, ///< binary, little endian: field NAME is scalar_NAME, as CloudCompare wants it; normals nx ny nz; red green
         ///< blue
    csv, ///< a row of names, then a row for each point; rgb as one whole number
    vtk, ///< legacy VTK, binary: a vertex for each point, fields as scalars, normals and rgb as such
};

/// Writes a cloud part by part. In whatever format, x y z are floats.
class CloudWriter {
  public:
    /// @param points  of all parts   @param units  of the numbers written
    CloudWriter(std::ostream& out, CloudFormat format, const Units& units, std::size_t points);
    ~CloudWriter();

    /// The first part says what fields there are.
    void write(const Cloud& part);
    /// After the last part, of which there is at least one.
    void finish();

    struct Encoder;

  private:
    std::unique_ptr<Encoder> encoder_;
};

} // namespace fettle
