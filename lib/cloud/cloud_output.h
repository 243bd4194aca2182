#pragma once

#include "cli/tool.h"
#include "cloud/cloud.h"
#include "cloud/cloud_writer.h"
#include "units/units.h"

#include <optional>
#include <string>
#include <vector>

namespace fettle::cloud {

/// Suffixes of the formats of clouds; the first is that of stdout.
const std::vector<std::string>& cloud_formats();
/// @param suffix  one of cloud_formats()
CloudFormat cloud_format(const std::string& suffix, bool ascii);

/// The options by which every tool that writes a cloud says how: --format, --units, --ascii. To be declared before
/// parse(). The references are those of the tool.
struct CloudOutput {
    /// @param others  suffixes of what the tool writes instead of a cloud, if its options say so
    explicit CloudOutput(cli::Tool& tool, const std::vector<std::string>& others = {});

    /// Units of the numbers that are written, and of the report: --units, else `own`.
    units::Units units(const units::Units& own) const;
    /// For a tool that has others: checks the format. @param writes_cloud  what the tool's options say
    /// @param hint  the options that write the other   @param writes_trace  whether another output is a cloud
    /// @throws InputError
    void require(bool writes_cloud, const std::string& hint, bool writes_trace = false) const;
    /// Writes the main output. @param own  units if --units is not given
    void write(const Cloud& cloud, const units::Units& own) const;
    /// Writes another output, by the suffix of its name.
    void write(const std::string& path, const Cloud& cloud, const units::Units& own) const;

    const std::string& format;
    const std::optional<units::Units::Length>& unit;
    const bool& ascii;

  private:
    cli::Tool& tool_;
};

/// Writes a cloud to another output of a tool, by the suffix of its name; PCD without one.
void write_cloud(cli::Tool& tool, const std::string& path, const Cloud& cloud, const units::Units& units,
                 bool ascii = false);

/// Units of the report, and of the options' lengths, of a tool that measures: those of the job; without one those of
/// the file, but mm instead of metres, in which tolerances would be millionths.
units::Units measured_units(const units::Units& of_file, const std::optional<units::Units>& of_job);

} // namespace fettle::cloud
