#pragma once

#include "cli/tool.h"
#include "gantry/protocol.h"
#include "gantry/virtual_gantry.h"
#include "job/job.h"
#include "removal/height_field.h"
#include "sampling/scan.h"

#include <Eigen/Geometry>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace fettle::gantry {

/// Default and help of the options that choose a machine.
struct GantryOptionTexts {
    std::string fallback; ///< of --gantry; empty: none
    std::string choices = "virtual|virtual:dynamic|exec:COMMAND";
    std::string gantry;
    std::string machine = "The machine of virtual:dynamic, JSON; for a driver: how well its head measures";
};

/// The options that choose a machine. The references are those of the tool.
struct GantryOptions {
    GantryOptions(cli::Tool& tool, const GantryOptionTexts& texts);

    bool has_driver() const; ///< --gantry exec:COMMAND
    /// @throws InputError if --gantry is none of its choices, or --machine does not fit it
    void check() const;

    const std::string& kind;    ///< --gantry
    const std::string& machine; ///< --machine: file of a simulated machine with drives
    const double& timeout;      ///< --patience, s
};

/// --patience: of a driver's answer beyond the time of its move, s.
const double& declare_timeout(cli::Tool& tool);
/// --removal-factor: VirtualOptions::removal_factor.
const double& declare_removal_factor(cli::Tool& tool);

/// The options that name the part on a machine.
struct StockOptions {
    /// @param help  of a part that need not be given: what it is for; empty: it is required
    explicit StockOptions(cli::Tool& tool, const std::string& help = "");

    const std::string& file;                         ///< --stock
    const std::optional<units::Units::Length>& unit; ///< --stock-units
    const std::optional<double>& cell;               ///< --cell, in the job's length unit
};

struct Stock {
    removal::HeightField field;
    std::vector<std::string> warnings;  ///< that it may be the wrong part, and what was left out of it
    Eigen::Index dropped_triangles = 0; ///< of a mesh: their vertices are not finite
};

/// Reads the part as a height field.
/// @throws InputError as read_scan() and stock_from_scan(), or for cells wider than the wheel
Stock read_stock(const StockOptions& options, const job::Job& job, removal::Extent extent);

/// The job with a safe height: where its file gives none, over the stock's top.
job::Job with_safe_height_over(const removal::HeightField& stock, job::Job job);

/// @param source  the stock's name for the message
/// @throws InputError if the stock stands as high as the job's safe height: the wheel would travel through it
void require_below_safe_height(const removal::HeightField& stock, const job::Job& job, const std::string& source);

/// As read_stock(), of a part that has been read already. @param part  the contents of options.file
Stock stock_of_part(const sampling::Scan& part, const StockOptions& options, const job::Job& job,
                    removal::Extent extent);

/// A machine that can be moved.
struct OpenGantry {
    std::unique_ptr<Gantry> gantry;
    protocol::Limits limits;
    const VirtualGantry* simulated = nullptr; ///< the same machine, if it is simulated
};

/// Starts the driver, or makes the simulated machine. @param stock  of a simulated machine; a driver has its own
/// @param T_cell_job  of a robot's driver: where the job lies in its cell, mm
/// @throws InputError if that fails, GantryFault if the driver is at fault
OpenGantry open_gantry(const GantryOptions& options, const job::Job& job, const removal::HeightField& stock,
                       std::uint64_t seed, double removal_factor = 1,
                       const std::optional<Eigen::Isometry3d>& T_cell_job = std::nullopt);

} // namespace fettle::gantry
