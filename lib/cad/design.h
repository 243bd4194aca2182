#pragma once

#include "core/progress.h"

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace fettle::cad {

/// The shapes behind a design, in the types of OpenCASCADE (shapes.h); they stay inside this module.
struct Shapes;

/// A face of a design, as the file describes it.
struct Face {
    std::string part; ///< name of the part that it belongs to, with those of its assemblies: "vice/jaw"; may be empty
    std::string name; ///< its own; most files have none
    std::string surface; ///< "plane", "cylinder", "cone", "sphere", "torus", "B-spline", …
    std::optional<std::array<std::uint8_t, 3>> colour; ///< red, green, blue; its own, else that of its part
};

/// A design as CAD writes it: solids with all their faces where the file's assemblies place them, mm.
class Design {
  public:
    explicit Design(std::unique_ptr<Shapes> shapes);
    Design(Design&&) noexcept;
    ~Design();

    const std::vector<Face>& faces() const;
    /// How messages call a face: "face 12 ('slot' of 'vice/jaw')"; faces are counted from 0.
    std::string describe(std::size_t face) const;
    int solids() const;
    /// Faces that belong to no solid beside those that do: they are left out.
    int loose_faces() const;
    /// Unit of length that the file states, as it names it: "millimetre", "INCH".
    const std::string& file_unit() const;
    const Shapes& shapes() const;

  private:
    std::unique_ptr<Shapes> shapes_;
};

/// Reads STEP (AP203, AP214, AP242) or IGES; the content decides which. Lengths are converted from the unit that the
/// file states. Faces that belong to no solid are sewn together.
/// @param path  a file, or "-" for stdin
/// @param gap   faces closer than this are sewn at their edges, mm
/// @throws InputError for a file of another kind or a damaged one, one without a unit of length, without a solid, and
///         for a face that OpenCASCADE cannot build, which is named
Design read_design(const std::string& path, double gap);

} // namespace fettle::cad
