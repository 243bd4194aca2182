#include "mesh/part_output.h"

#include "core/error.h"

namespace fettle::mesh {

PartOutput::PartOutput(cli::Tool& tool)
    : PartOutput(tool, {"pcd", "ply", "csv", "vtk", "stl"}, "pcd, or stl for a mesh")
{
}

PartOutput::PartOutput(cli::Tool& tool, const std::vector<std::string>& formats, const std::string& otherwise)
    : format(tool.output_format(formats, otherwise)),
      unit(tool.length_unit("--units", "Unit of the lengths written; default: that of what is read")),
      ascii(tool.flag("--ascii", "Write PCD as text")), tool_(tool)
{
}

PartFormat PartOutput::format_for(bool is_mesh) const
{
    const PartFormat found = part_format(tool_.output_name(), format, is_mesh);
    if (ascii && found != PartFormat::pcd) throw core::InputError("--ascii", "goes with PCD");
    return ascii ? PartFormat::pcd_ascii : found;
}

units::Units PartOutput::units(const units::Units& own) const { return {unit.value_or(own.length), own.force}; }

void PartOutput::write(const CloudMesh& part, const units::Units& own) const
{
    write_cloud_mesh(tool_.output(), part, format_for(part.is_mesh()), units(own));
}

} // namespace fettle::mesh
