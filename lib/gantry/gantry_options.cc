#include "gantry/gantry_options.h"

#include "core/file.h"
#include "core/text.h"
#include "gantry/driver.h"
#include "gantry/make_virtual.h"
#include "job/safe_height.h"

namespace fettle::gantry {
namespace {

const std::string kDriver = "exec:", kVirtual = "virtual", kDynamic = "virtual:dynamic"; // values of --gantry

} // namespace

GantryOptions::GantryOptions(cli::Tool& tool, const GantryOptionTexts& texts)
    : kind(tool.text("--gantry", texts.fallback, texts.choices, texts.gantry)),
      machine(tool.optional_file("--machine", "FILE", texts.machine)), timeout(declare_timeout(tool))
{
}

bool GantryOptions::has_driver() const { return kind.starts_with(kDriver) && kind != kDriver; }

void GantryOptions::check() const
{
    if (!has_driver() && kind != kVirtual && kind != kDynamic)
        throw core::InputError("--gantry: '" + kind + "' is none of virtual, virtual:dynamic, exec:COMMAND");
    if ((kind == kDynamic && machine.empty()) || (kind == kVirtual && !machine.empty()))
        throw core::InputError("--machine",
                               "goes with --gantry virtual:dynamic, which needs it, or exec:COMMAND; not with virtual");
}

const double& declare_timeout(cli::Tool& tool)
{
    return tool.number("--patience", 10, "SECONDS", "Timeout of a driver's answer, beyond the time of its move",
                       core::Range::positive());
}

const double& declare_removal_factor(cli::Tool& tool)
{
    constexpr double kMaxFactor = 1000; // from chilled iron to wax; beyond it the sums of a run lose their digits
    return tool.number("--removal-factor", 1, "FACTOR",
                       "Removal coefficient of the simulated stock, relative to the job's",
                       core::Range::between(1 / kMaxFactor, kMaxFactor));
}

StockOptions::StockOptions(cli::Tool& tool, const std::string& help)
    : file(help.empty() ? tool.required_file_option("--stock", "PART", "The part as it is: STL, PLY, OBJ or PCD")
                        : tool.optional_file("--stock", "PART", "The part as it is, STL, PLY, OBJ or PCD: " + help)),
      unit(tool.length_unit("--stock-units", "Unit of PART, if it is not the job's")),
      cell(tool.optional_number("--cell", "LENGTH", "Side of a cell of the stock; default: 1/64 of the wheel's width",
                                core::Range::positive()))
{
}

Stock read_stock(const StockOptions& options, const job::Job& job, removal::Extent extent)
{
    return stock_of_part(sampling::read_scan(options.file, job, options.unit), options, job, extent);
}

Stock stock_of_part(const sampling::Scan& part, const StockOptions& options, const job::Job& job,
                    removal::Extent extent)
{
    const std::string source = core::display_name(options.file);
    const double cell = stock_cell_size(job, options.cell ? *options.cell * job.units.mm() : 0);
    if (cell > job.wheel.width)
        throw core::InputError("--cell", core::to_short_text(cell / job.units.mm()) + " is wider than the wheel, " +
                                             core::to_short_text(job.wheel.width / job.units.mm()));
    return {removal::stock_from_scan(part, job, cell, source, extent), sampling::scan_warnings(part, job, source),
            part.repair().dropped_triangles};
}

job::Job with_safe_height_over(const removal::HeightField& stock, job::Job job)
{
    job::set_safe_height_over(job, stock.z.maxCoeff<Eigen::PropagateNumbers>());
    return job;
}

void require_below_safe_height(const removal::HeightField& stock, const job::Job& job, const std::string& source)
{
    const double mm = job.units.mm(), highest = stock.z.maxCoeff<Eigen::PropagateNumbers>();
    if (highest >= job.safe_height)
        throw core::InputError(source, "stands at z " + core::to_short_text(highest / mm) + ", not below safe_height " +
                                           core::to_short_text(job.safe_height / mm) +
                                           ": the wheel would travel through it");
}

OpenGantry open_gantry(const GantryOptions& options, const job::Job& job, const removal::HeightField& stock,
                       std::uint64_t seed, double removal_factor, const std::optional<Eigen::Isometry3d>& T_cell_job)
{
    if (options.has_driver()) {
        std::optional<Head> head;
        if (!options.machine.empty()) head = read_machine(options.machine).head;
        auto driver =
            std::make_unique<DriverGantry>(options.kind.substr(kDriver.size()), job, options.timeout, head, T_cell_job);
        const protocol::Limits limits = driver->limits();
        return {std::move(driver), limits, nullptr};
    }
    auto simulated = make_virtual_gantry(stock, job, {options.machine, removal_factor, seed});
    const VirtualGantry* const same = simulated.get();
    return {std::move(simulated), same->limits(), same};
}

} // namespace fettle::gantry
