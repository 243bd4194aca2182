#pragma once

#include "calibrate/law_record.h"
#include "job/job.h"
#include "removal/height_field.h"
#include "strategy/run.h"

#include <optional>
#include <string>
#include <vector>

namespace fettle::calibrate {

/// What a gantry learns from run to run: the file that hands it on, and its record.
class RunLearning {
  public:
    /// @param path  of kind "law"; where there is no file yet, nothing is known
    /// @throws InputError if the file is no gantry's law
    explicit RunLearning(const std::string& path);

    /// The job with the removal coefficient that is expected of the next pass at the mean force of all; as it is where
    /// nothing is known.
    job::Job informed(job::Job job) const;
    /// What else is known of the removal; nothing where the coefficient is not.
    std::optional<strategy::KnownRemoval> known() const;
    bool is_informed() const { return !record_.passes.empty(); }

    /// Learns from the strokes of a run: each is predicted from those before, of former runs, too.
    /// @param before  stock before the run
    void learn_from(const std::vector<strategy::TraceRow>& trace, const job::Job& job,
                    const removal::HeightField& before);
    /// A line for each stroke of the last run that the law does not explain.
    std::vector<std::string> warnings() const;
    /// Numbers about the last run: passes, judged, covered, changes, median_error; and the coefficient, mm³/(N s), and
    /// its standard deviation relative to it, which are expected of the next.
    json::Value report() const;
    /// The file with what is known now; an empty object if nothing is.
    json::Value file() const;

  private:
    double coefficient(const LearntLaw& law) const; ///< mm³/(N s)

    LawRecord record_;
    std::size_t known_passes_ = 0; ///< before the last run
};

} // namespace fettle::calibrate
