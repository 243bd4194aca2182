#pragma once

#include "belt/belt_journal.h"
#include "belt_calibrate/belt_pass.h"
#include "calibrate/law_record.h"

#include <optional>
#include <string>
#include <vector>

namespace fettle::belt_calibrate {

/// What a belt learns while it grinds, pass by pass. Before a pass the simulation by the law, as far as it is known,
/// says what it will remove from the surfels as they are, the belief within which interval, and the feeds of the pass
/// are changed so that it removes what its path was planned for. After it, the surfels say what it was: the pass as a
/// whole, which is judged, and by parts of like pressure and feed (divide_pass()), which tell the exponents, too. The
/// trials are those of measure_belt (belt_run.h); their base is the law of the first wheel.
class BeltLearning : public belt::PassSupervisor {
  public:
    /// Keeps references to all but the file's name and the options.
    /// @param file  of the law: a wheel that was learnt; where there is no file yet, nothing is known
    /// @param wheel  for which the path was planned
    /// @param surfels  that are ground
    /// @param path  whose feeds are changed
    /// @throws InputError if the file is no belt's law
    BeltLearning(const std::string& file, const belt::ContactWheel& wheel, const belt::BeltOptions& options,
                 const belt::Surfels& surfels, std::vector<belt::BeltPoint>& path);

    /// Digest of the passes that were known beforehand and of the wheel, for BeltJournal::context_digest.
    std::string context_digest() const;
    void resume(const belt::BeltRun& run) override;
    void begin_pass(const belt::BeltGrinding& grinding, std::size_t first, std::size_t end) override;
    belt::MeasuredPass end_pass(const belt::BeltRun& run) override;

    /// Is anything known of the law?
    bool is_informed() const { return law_.has_value(); }
    /// A line for each pass of this run that the law does not explain, with its number on the path.
    std::vector<std::string> warnings() const;
    /// As RunLearning::report(), with coefficient and exponents of the law that is expected of the next pass; and
    /// `predictions`: of each pass of this run its volume, mm³, its feed_factor, what was expected of it (expected,
    /// lower, upper), and whether it has a change.
    json::Value report() const;
    /// The wheel with that law, and the record; only if something is known.
    json::Value file() const;

  private:
    /// A pass of this run.
    struct RunPass {
        belt::MeasuredPass measured;
        std::size_t number;                             ///< on the path, from 1
        std::optional<calibrate::Prediction> predicted; ///< of the trial's volume; none: nothing was known
    };
    /// The pass that is being ground.
    struct CurrentPass {
        std::size_t first = 0, end = 0;
        std::vector<belt::BeltPoint> planned;
        Eigen::VectorXd before;   ///< displacements of the surfels, mm
        belt::ContactWheel wheel; ///< with the law that is known
        SimulatedPass simulated;  ///< by it
        double feed_factor = 1;
    };

    /// Conditions, and the volume by a wheel's law.  @param work  of this run before, N mm
    removal::RemovalTrial trial_at(const belt::ContactWheel& wheel, double pressure, double feed, double work) const;
    /// The wheel with the law that is known, as fast under these conditions as is expected of it.
    belt::ContactWheel known_wheel(double pressure, double feed, double work) const;
    belt::ContactWheel next_wheel() const;
    /// The factor for the feeds of the pass by which it removes as much as its path was planned for.
    double feed_factor(double pressure, double planned_feed, double work) const;
    void plan_pass(std::size_t first, std::size_t end);
    void scale_feeds(double factor);
    bool simulate(const belt::BeltGrinding& grinding);
    void add(const belt::MeasuredPass& measured);

    const belt::ContactWheel& wheel_;
    belt::BeltOptions options_;
    const belt::Surfels& surfels_;
    std::vector<belt::BeltPoint>& path_;
    Eigen::VectorXd lengths_; ///< tributary, of the points, mm
    calibrate::LawRecord record_;
    std::optional<calibrate::LearntLaw> law_; ///< none: there is no pass in the record
    std::size_t known_passes_ = 0;            ///< before this run
    double known_work_ = 0;                   ///< of the belt before this run, N mm
    std::size_t path_passes_ = 0;             ///< ground in this run
    std::vector<RunPass> passes_;
    CurrentPass pass_;
};

} // namespace fettle::belt_calibrate
