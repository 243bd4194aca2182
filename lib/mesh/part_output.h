#pragma once

#include "cli/tool.h"
#include "mesh/cloud_mesh.h"
#include "units/units.h"

#include <optional>
#include <string>
#include <vector>

namespace fettle::mesh {

/// The options by which every tool that writes a part, a cloud or a mesh, says how: --format, --units, --ascii. To be
/// declared before parse(). The references are those of the tool.
struct PartOutput {
    /// Any format, PCD or STL by what is written.
    explicit PartOutput(cli::Tool& tool);
    /// @param formats, otherwise  as those of Tool::output_format()
    PartOutput(cli::Tool& tool, const std::vector<std::string>& formats, const std::string& otherwise = "");

    /// @throws InputError for a mesh as PCD, CSV or VTK, which have no triangles, and for a cloud as STL
    PartFormat format_for(bool is_mesh) const;
    /// Units of the numbers that are written: --units, else `own`.
    units::Units units(const units::Units& own) const;
    /// Writes the main output. @throws InputError as format_for()
    void write(const CloudMesh& part, const units::Units& own) const;

    const std::string& format;
    const std::optional<units::Units::Length>& unit;
    const bool& ascii;

  private:
    cli::Tool& tool_;
};

} // namespace fettle::mesh
