#include "belt/belt_options.h"

namespace fettle::belt {
namespace {

// Bounds of --tolerance. Below the lower one rounding of the pressures' convolution decides, and the solver would not
// converge; above the upper one the pressure is visibly wrong at the edge of the contact.
constexpr double kMinContactTolerance = 1e-9;
constexpr double kMaxContactTolerance = 1e-2;
constexpr int kMaxFemCells = 256; // along a side: memory grows with the cube, 140 MB here

} // namespace

ContactOptions::ContactOptions(cli::Tool& tool, int default_cells, double default_tolerance)
    : gridding(tool.choice<Gridding>("--gridding", {{"kriging", Gridding::kriging}, {"shepard", Gridding::shepard}},
                                     "How heights between surfels are estimated")),
      cells(tool.count("--cells", default_cells,
                       "Number of cells along each side of the grid; up to twice as many along a long contact", 8,
                       512)),
      tolerance(tool.number("--tolerance", default_tolerance, "SHARE",
                            "Maximum of pressure times gap, as a share of peak pressure times indentation",
                            core::Range::between(kMinContactTolerance, kMaxContactTolerance))),
      solver(tool.choice<LayerSolver>("--solver", {{"layer", LayerSolver::layer}, {"fem", LayerSolver::fem}},
                                      "Compliance of the bonded layer, flat and, with up to 128 --cells, with free "
                                      "sides; or linear finite elements of "
                                      "the round layer with its sides, of 256 --cells at most")),
      elements(tool.count("--elements", WheelContactOptions{}.elements, "From the surface to the hub, of --solver fem",
                          1, 64))
{
}

void ContactOptions::check() const
{
    if (solver == LayerSolver::fem && cells > kMaxFemCells)
        throw core::InputError("--cells", "at most " + std::to_string(kMaxFemCells) + " with --solver fem");
}

WheelContactOptions ContactOptions::values() const { return {gridding, cells, tolerance, solver, elements}; }

GrindingOptions::GrindingOptions(cli::Tool& tool)
    : force(tool.optional_number("--force", "FORCE", "At all points, N", core::Range::positive())),
      depth(tool.optional_number("--depth", "LENGTH", "Indentation at all points", core::Range::positive())),
      feed(tool.optional_number("--feed", "LENGTH/S", "Where the path has no field feed [20 mm/s]",
                                core::Range::positive())),
      dwell(tool.number("--dwell", 0, "S", "Additional time at both ends of each run", core::Range::at_least(0))),
      worn(tool.number("--worn", 0, "J", "Work that the belt has done before (report: work)", core::Range::at_least(0)))
{
}

void GrindingOptions::check() const
{
    if (force && depth) throw core::InputError("--force", "and --depth: one of them says how the wheel is pressed on");
}

BeltSettings GrindingOptions::settings(double mm) const
{
    BeltSettings settings;
    settings.force = force;
    if (depth) settings.depth = *depth * mm;
    if (feed) settings.feed = *feed * mm;
    settings.dwell = dwell;
    return settings;
}

double GrindingOptions::prior_work() const { return worn * kNewtonMmPerJoule; }

} // namespace fettle::belt
