#include "cloud/cloud_output.h"

#include "cli/output_format.h"
#include "core/error.h"

#include <algorithm>

namespace fettle::cloud {
namespace {

void write_cloud_as(std::ostream& out, const Cloud& cloud, CloudFormat format, const units::Units& units)
{
    CloudWriter writer(out, format, units, static_cast<std::size_t>(cloud.size()));
    writer.write(cloud);
    writer.finish();
}

std::vector<std::string> with_others(const std::vector<std::string>& others)
{
    std::vector<std::string> formats = cloud_formats();
    formats.insert(formats.end(), others.begin(), others.end());
    return formats;
}

} // namespace

const std::vector<std::string>& cloud_formats()
{
    static const std::vector<std::string> formats = {"pcd", "ply", "csv", "vtk"};
    return formats;
}

CloudFormat cloud_format(const std::string& suffix, bool ascii)
{
    if (suffix == "ply") return CloudFormat::ply;
    if (suffix == "csv") return CloudFormat::csv;
    if (suffix == "vtk") return CloudFormat::vtk;
    return ascii ? CloudFormat::pcd_ascii : CloudFormat::pcd;
}

CloudOutput::CloudOutput(cli::Tool& tool, const std::vector<std::string>& others)
    : format(others.empty() ? tool.output_format(cloud_formats())
                            : tool.output_format(with_others(others), "by what is written")),
      unit(tool.length_unit("--units", "Unit of the lengths written; default: that of what is read")),
      ascii(tool.flag("--ascii", "Write PCDs as text")), tool_(tool)
{
}

units::Units CloudOutput::units(const units::Units& own) const { return {unit.value_or(own.length), own.force}; }

void CloudOutput::require(bool writes_cloud, const std::string& hint, bool writes_trace) const
{
    const bool is_cloud = std::ranges::find(cloud_formats(), format) != cloud_formats().end();
    if (!format.empty() && is_cloud != writes_cloud)
        throw core::InputError(cli::suffix_of(tool_.output_name()) == format ? tool_.output_name() : "--format",
                               "is not written as " + format + ": " + hint);
    if (ascii && !writes_cloud && !writes_trace) throw core::InputError("--ascii", hint);
}

void CloudOutput::write(const Cloud& cloud, const units::Units& own) const
{
    if (ascii && !format.empty() && format != "pcd")
        throw core::InputError("--ascii", "goes with PCD, not with " + format);
    write_cloud_as(tool_.output(), cloud, cloud_format(format, ascii), units(own));
}

void CloudOutput::write(const std::string& path, const Cloud& cloud, const units::Units& own) const
{
    write_cloud(tool_, path, cloud, units(own), ascii);
}

void write_cloud(cli::Tool& tool, const std::string& path, const Cloud& cloud, const units::Units& units, bool ascii)
{
    const std::string suffix = cli::format_of_output(path, cloud_formats());
    write_cloud_as(tool.output_file(path), cloud, cloud_format(suffix, ascii), units);
}

units::Units measured_units(const units::Units& of_file, const std::optional<units::Units>& of_job)
{
    if (of_job) return *of_job;
    if (of_file.length != units::Units::Length::m) return of_file;
    return {units::Units::Length::mm, of_file.force};
}

} // namespace fettle::cloud
