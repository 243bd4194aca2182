#pragma once

#include "gantry/gantry_options.h"
#include "job/job.h"
#include "removal/height_field.h"
#include "strategy/run.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace fettle::station {

struct WorkplaceOptions {
    const gantry::GantryOptions& gantry;
    const gantry::StockOptions& stock; ///< required of a simulated machine; a driver's may be unknown
    double removal_factor = 1;
    std::uint64_t seed = 1;
};

/// The machine of a session, and the part on it. A driver's machine stays connected from the first use on. A simulated
/// one is made anew for another θ, and when grinding begins: over the stock as fettle-grind has it, ground as far as
/// the traces say.
class Workplace {
  public:
    /// @throws InputError if the stock does not go with the machine
    explicit Workplace(const WorkplaceOptions& options);

    bool is_simulated() const { return !options_.gantry.has_driver(); }
    /// True if the machine can hold a force, for Mode::manual, as far as that is known.
    bool can_press() const;

    /// The machine with its head at the job's θ, to show and touch points: over the whole part.
    /// @throws InputError, GantryFault as open_gantry()
    gantry::OpenGantry& open_to_touch(const job::Job& job);
    /// The machine for grinding. @param traces  of what was ground   @throws as above
    gantry::OpenGantry& open_to_grind(const job::Job& job, const std::vector<std::vector<strategy::TraceRow>>& traces);
    /// Is there a machine yet?
    bool is_open() const { return machine_.gantry != nullptr; }
    gantry::OpenGantry& machine() { return machine_; }
    void close()
    {
        machine_.gantry.reset();
        machine_.simulated = nullptr;
    }

    /// The part's stock over the anomaly before anything was ground; empty if it is not known.
    const removal::HeightField& stock(const job::Job& job);
    /// Before the probe travels over it: a part that is known stands below the job's safe height inside S.
    /// @throws InputError if not
    void require_safe_height(const job::Job& job);
    /// The stock after grinding, as far as it is known: a simulated machine's own.
    removal::HeightField ground(const job::Job& job, const std::vector<std::vector<strategy::TraceRow>>& traces);
    std::vector<std::string> warnings; ///< about the stock

  private:
    enum class Purpose { none, touch, grind };
    const sampling::Scan& part(const job::Job& job);
    removal::HeightField whole_part(const job::Job& job);
    gantry::OpenGantry& open(const job::Job& job, const removal::HeightField& stock, Purpose purpose);

    WorkplaceOptions options_;
    gantry::OpenGantry machine_;
    Purpose purpose_ = Purpose::none;
    double theta_ = 0;                           ///< of the head, rad
    std::shared_ptr<const sampling::Scan> part_; ///< read once: it may come from a pipe
    std::optional<removal::HeightField> stock_;
};

} // namespace fettle::station
