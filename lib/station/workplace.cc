#include "station/workplace.h"

#include "core/error.h"
#include "core/file.h"
#include "gantry/make_virtual.h"
#include "sampling/scan.h"
#include "strategy/trace.h"

#include <utility>

namespace fettle::station {
namespace {

removal::HeightField replay(removal::HeightField stock, const job::Job& job,
                            const std::vector<std::vector<strategy::TraceRow>>& traces)
{
    if (stock.z.size() == 0) return stock;
    for (const std::vector<strategy::TraceRow>& trace : traces)
        stock = strategy::replay_removal(trace, job, std::move(stock));
    return stock;
}

} // namespace

Workplace::Workplace(const WorkplaceOptions& options) : options_(options)
{
    if (is_simulated() && options.stock.file.empty()) throw core::InputError("--stock", "goes with a virtual gantry");
}

bool Workplace::can_press() const { return !is_simulated() || !options_.gantry.machine.empty(); }

gantry::OpenGantry& Workplace::open_to_touch(const job::Job& job)
{
    if (!is_open() || (is_simulated() && (purpose_ != Purpose::touch || job.theta != theta_)))
        return open(job, is_simulated() ? whole_part(job) : removal::HeightField{}, Purpose::touch);
    if (job.theta != theta_) machine_.gantry->turn_to(job.theta);
    theta_ = job.theta;
    return machine_;
}

gantry::OpenGantry& Workplace::open_to_grind(const job::Job& job,
                                             const std::vector<std::vector<strategy::TraceRow>>& traces)
{
    if (is_open() && (!is_simulated() || purpose_ == Purpose::grind)) return machine_;
    return open(job, is_simulated() ? replay(stock(job), job, traces) : removal::HeightField{}, Purpose::grind);
}

gantry::OpenGantry& Workplace::open(const job::Job& job, const removal::HeightField& stock, Purpose purpose)
{
    close(); // a driver's machine has one client
    machine_ = gantry::open_gantry(options_.gantry, job, stock, options_.seed, options_.removal_factor);
    purpose_ = purpose;
    theta_ = job.theta;
    return machine_;
}

const sampling::Scan& Workplace::part(const job::Job& job)
{
    const gantry::StockOptions& options = options_.stock;
    if (!part_) part_ = std::make_shared<const sampling::Scan>(sampling::read_scan(options.file, job, options.unit));
    return *part_;
}

removal::HeightField Workplace::whole_part(const job::Job& job)
{
    const std::optional<double>& cell = options_.stock.cell;
    return removal::stock_over_scan(part(job), job.theta,
                                    gantry::stock_cell_size(job, cell ? *cell * job.units.mm() : 0));
}

const removal::HeightField& Workplace::stock(const job::Job& job)
{
    if (stock_) return *stock_;
    if (options_.stock.file.empty()) return stock_.emplace();
    gantry::Stock stock = gantry::stock_of_part(part(job), options_.stock, job, removal::Extent::anomaly);
    gantry::require_below_safe_height(stock.field, job, core::display_name(options_.stock.file));
    warnings = std::move(stock.warnings);
    return stock_.emplace(std::move(stock.field));
}

void Workplace::require_safe_height(const job::Job& job)
{
    if (options_.stock.file.empty() || !job.is_safe_height_known) return;
    const gantry::Stock stock = gantry::stock_of_part(part(job), options_.stock, job, removal::Extent::sampling);
    gantry::require_below_safe_height(stock.field, job, core::display_name(options_.stock.file));
}

removal::HeightField Workplace::ground(const job::Job& job, const std::vector<std::vector<strategy::TraceRow>>& traces)
{
    if (machine_.simulated != nullptr && purpose_ == Purpose::grind) return machine_.simulated->stock();
    return replay(stock(job), job, traces);
}

} // namespace fettle::station
