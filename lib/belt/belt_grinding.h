#pragma once

#include "belt/belt_path.h"
#include "belt/press.h"
#include "belt/running_error.h"
#include "core/progress.h"
#include "removal/removal_fit.h"

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace fettle::belt {

/// Distribution of the force: the local model takes the pressure of the contact (Ren et al. 2006); the global one
/// spreads the force evenly over the bounding rectangle of the contact, which is Hammann's linear model (1998):
/// r = C_A K_A k_t V_b / (V_w L_w) F over the width L_w.
enum class BeltModel { local, global };

struct BeltOptions {
    WheelContactOptions contact;
    BeltModel model = BeltModel::local;
    double prior_work = 0;               ///< work that the belt did before this run, N mm
    bool keep_removals = false;          ///< fill BeltRun::removals
    std::optional<ToleranceRange> range; ///< for the errors after each point; without it BeltRun::errors stays empty
};

/// Largest cells of the contact's grid over the surfels' spacing at which ripples from surfel to surfel are ground off:
/// of larger ones, half a wave and more is hidden in each.
inline constexpr double kMaxCellSpacings = 1;

/// Contact and removal at one point of the path; NaN where the wheel is off the part.
struct BeltTrace {
    double time = 0; ///< at the end of the point, since the start, s
    double duration = 0, force = 0, indentation = 0, peak_pressure = 0, area = 0;
    double removed_volume = 0; ///< integral of the law's depth over the contact, mm³
};

/// Depth that one surfel loses at one point of the path: an entry of the sparse removal matrix.
struct SurfelRemoval {
    Eigen::Index surfel;
    std::size_t point;
    double depth; ///< along the surfel's normal, mm
};

/// Errors of all surfels after a point of the path.
struct BeltError {
    Eigen::Index gouge = 0, within = 0, undercut = 0; ///< surfels
    double mean = 0, rms = 0, min = 0;                ///< mm
};

/// What was measured of a pass of a path: the path from a touchdown to the next.
struct MeasuredPass {
    removal::RemovalTrial trial; ///< volume 0: the pass has no length, or removed nothing
    double contact_volume = 0;   ///< volume of the pass, mm³, per volume of the trial
    double sensitivity = 1;      ///< derivative of the logarithm of the pass's volume by that of the law's coefficient
    double work = 0;             ///< of the belt, N mm
    double feed_factor = 1;      ///< by which the feeds of the path were multiplied
    std::vector<removal::RemovalTrial> parts; ///< of the pass, if its pressure or feed varied
};

/// Results of a grinding run.
struct BeltRun {
    std::vector<BeltTrace> trace;
    Eigen::VectorXd removed;             ///< depth that each surfel lost along its normal, mm
    double removed_volume = 0;           ///< mm³
    double work = 0;                     ///< that the belt did in this run, N mm (BeltLaw)
    Eigen::Index near_edge = 0;          ///< points whose contact is near the layer's free edge
    Eigen::Index coarse_grids = 0;       ///< points whose grid has larger cells than the surfels are apart
    double max_cell_spacings = 0;        ///< largest cell over the surfels' spacing, at these points
    std::vector<SurfelRemoval> removals; ///< ordered by point; empty without BeltOptions::keep_removals
    std::vector<BeltError> errors;       ///< one for each point; empty without BeltOptions::range
    std::vector<MeasuredPass> passes;    ///< that a PassSupervisor measured (belt_journal.h)
};

/// Checkpoint of a run: everything that the next point depends on, except the surfels' displacements.
struct BeltState {
    std::size_t next_point = 0; ///< index in the path
    BeltRun run;
    std::optional<RunningError> error;
    WheelContactState contact;
};

/// Grinds along a path, point by point. At each point the surfels under the contact lose depth along their normals by
/// the wheel's law; the time is that for the point's tributary length (belt_path.h) plus the dwell. The law gives the
/// depth normal to the tangent plane, so that the integral of the pressure is the force whatever the surfels' normals
/// are (Ren et al. 2006, 4). The pressure is that when a share of the point's removal has made room, between half and
/// all (press.cc): so ripples shrink, and with force F the volume is that of F all the same. Ripples that the grid does
/// not resolve stay (BeltRun::coarse_grids). The global model takes the pressure at the beginning.
class BeltGrinding {
  public:
    /// Keeps references to all arguments except the options.
    BeltGrinding(Surfels& surfels, const ContactWheel& wheel, const std::vector<BeltPoint>& path,
                 const BeltOptions& options);
    BeltGrinding(const BeltGrinding&) = delete;
    BeltGrinding& operator=(const BeltGrinding&) = delete;

    bool is_done() const { return state_.next_point == path_.size(); }
    /// Share of the points that are ground, of a path that has some.
    double progress() const { return static_cast<double>(state_.next_point) / static_cast<double>(path_.size()); }
    /// Grinds the next point.
    /// @throws InputError naming the point if nothing is under the wheel, or the contact does not converge
    void step();

    const BeltRun& run() const { return state_.run; }
    std::size_t next_point() const { return state_.next_point; }
    /// Grid of the last contact, with which the next one begins. It has no rows while it is not known.
    const ContactGrid& contact_grid() const { return solver_.contact_grid(); }
    void set_contact_grid(const ContactGrid& grid) { solver_.restore({grid, {}, {}}); }
    void add_pass(const MeasuredPass& pass) { state_.run.passes.push_back(pass); }
    /// Checkpoint for restore(); the caller keeps the displacements of the surfels.
    BeltState state() const;
    /// Continues from a checkpoint. The surfels must have the displacements that they had then.
    void restore(BeltState state);

  private:
    void remove_material(const WheelContact& contact, const Eigen::MatrixXd& depth, double duration);
    void count_coarse_grid(const WheelContact& contact);

    Surfels& surfels_;
    const ContactWheel& wheel_;
    const std::vector<BeltPoint>& path_;
    BeltOptions options_;
    Eigen::VectorXd tributary_lengths_; ///< of the points, mm
    BeltState state_;
    WheelContactSolver solver_; ///< refers to the state
};

/// Grinds the whole path.
/// @throws InputError as BeltGrinding::step()
BeltRun grind(Surfels& surfels, const ContactWheel& wheel, const std::vector<BeltPoint>& path,
              const BeltOptions& options, const core::Progress& progress = {});

} // namespace fettle::belt
