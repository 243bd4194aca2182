#include "station/station.h"

#include "core/constants.h"
#include "core/error.h"
#include "job/boundary.h"
#include "station/machine_work.h"
#include "json/units.h"

#include <cmath>
#include <ostream>
#include <utility>

namespace fettle::station {
namespace {

constexpr double kTurn = core::kRadPerDegree; // of the head by a key, rad

/// The record that a session begins with.
Record first_record(const job::Job& settings, const Folder& folder, bool resume)
{
    if (!folder.has(kRecordFile)) return begin_record(settings);
    if (!resume) throw core::InputError(folder.file(kRecordFile), "holds a session: --resume goes on with it");
    Record record = parse_record(json::Reader::open(folder.file(kRecordFile)));
    if (job::to_json(record.settings).text() != job::to_json(settings).text())
        throw core::InputError(folder.file(kRecordFile), "belongs to another job than " + settings.source);
    return record;
}

class Station {
  public:
    Station(const job::Job& settings, strategy::Steering& steering, const StationOptions& options)
        : options_(options), folder_(options.folder),
          session_(first_record(settings, folder_, options.resume)), clock_{steering}, place_(options.workplace),
          work_(options, folder_, session_, place_, clock_)
    {
    }

    StationResult run()
    {
        work_.prepare();
        save();
        while (step()) {
        }
        work_.leave();
        save();
        std::vector<std::string> warnings = work_.warnings();
        warnings.insert(warnings.end(), refusals_.begin(), refusals_.end());
        return {is_complete(), work_.failure(), warnings, report()};
    }

  private:
    bool step()
    {
        work_.show(false);
        strategy::Stick stick = clock_.stick();
        stick.end = stick.end || work_.is_terminated();
        const Stage before = session_.record().stage;
        const Command command = session_.input(stick);
        if (command == Command::end) return false;
        if (command == Command::none) {
            if (stick.button != strategy::Button::none || session_.record().stage != before) save();
            clock_.rest(strategy::kTeachingPeriod);
            return true;
        }
        execute(command, stick);
        if (command != Command::move) save();
        return true;
    }

    /// What fails is said to the operator, and the session goes on; a machine that has failed is connected anew.
    void execute(Command command, const strategy::Stick& stick)
    {
        try {
            perform(command, stick);
        } catch (const gantry::Interrupted& stop) {
            work_.retract();
            session_.refuse(stop.what());
        } catch (const gantry::GantryFault& fault) {
            work_.give_up(fault.what());
            session_.refuse(fault.what());
        } catch (const core::InputError& error) {
            session_.refuse(error.what());
            refusals_.push_back(error.what());
        }
    }

    void perform(Command command, const strategy::Stick& stick)
    {
        const double theta = session_.record().job.theta;
        switch (command) {
        case Command::move:
            return work_.move(stick.direction);
        case Command::record:
            return session_.add_point(work_.touch_here());
        case Command::turn_left:
            return work_.turn_to(theta + kTurn);
        case Command::turn_right:
            return work_.turn_to(theta - kTurn);
        case Command::touch:
            return work_.touch_and_plan([this] { save(); });
        case Command::grind:
            return work_.grind([this] { save(); });
        case Command::steer:
            return work_.steer([this] { save(); });
        default:
            return;
        }
    }

    bool is_complete() const
    {
        const Record& record = session_.record();
        const bool by_hand = record.stage == Stage::stopped && record.mode == Mode::manual && record.manual_runs > 0;
        return record.stage == Stage::done || (by_hand && work_.failure().empty());
    }

    void save()
    {
        folder_.save(kRecordFile, [this](std::ostream& out) { out << to_json(session_.record()); });
    }

    json::Value report() const
    {
        const Record& record = session_.record();
        json::Value report;
        report.set("kind", "station").set("units", json::to_json(record.job.units));
        job::add_report(report, record.job);
        std::vector<json::Value> stops;
        for (const auto& [asked, free, lifted] : record.stops)
            stops.push_back(json::Value().set("asked", asked).set("free", free).set("lifted", lifted));
        report.set("stage", kStageWords[std::size_t(record.stage)])
            .set("mode", kModeWords[std::size_t(record.mode)])
            .set("finished", record.stage == Stage::done)
            .set("touches", record.touches.size())
            .set("manual_runs", record.manual_runs)
            .set("peak_force", record.peak_force / record.job.units.newton())
            .set("stops", stops);
        if (const plan::Plan* plan = work_.plan())
            report.set("predicted_band", plan->surface.prediction->band / record.job.units.mm())
                .set("shift", plan->surface.prediction->shift / record.job.units.mm());
        return report;
    }

    const StationOptions& options_;
    Folder folder_;
    Session session_;
    strategy::SteeringClock clock_;
    Workplace place_;
    MachineWork work_;
    std::vector<std::string> refusals_; ///< what the screen has said, for a session that has none
};

} // namespace

StationResult run_station(const job::Job& settings, strategy::Steering& steering, const StationOptions& options)
{
    return Station(settings, steering, options).run();
}

} // namespace fettle::station
