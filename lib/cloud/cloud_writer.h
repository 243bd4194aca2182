#pragma once

#include "cloud/cloud.h"
#include "units/units.h"

#include <cstddef>
#include <iosfwd>
#include <memory>

namespace fettle::cloud {

/// File formats of point clouds. All hold every field; only PCD states its units.
enum class CloudFormat {
    pcd,       ///< binary
    pcd_ascii, ///< PCD as text
    ply, ///< binary, little endian: field NAME is scalar_NAME, as in CloudCompare; normals nx ny nz; red green blue
    csv, ///< a row of names, then a row per point; rgb as one integer
    vtk, ///< legacy VTK, binary: a vertex per point, fields as scalars, normals and rgb as such
};

/// Writes a cloud part by part. In all formats x y z are floats.
class CloudWriter {
  public:
    /// @param points  total of all parts   @param units  of the numbers written
    CloudWriter(std::ostream& out, CloudFormat format, const units::Units& units, std::size_t points);
    ~CloudWriter();

    /// Writes points; the first part determines the fields.
    void write(const Cloud& part);
    /// Completes the file after the last part; at least one must have been written.
    void finish();

    struct Encoder;

  private:
    std::unique_ptr<Encoder> encoder_;
};

} // namespace fettle::cloud
