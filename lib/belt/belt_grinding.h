#pragma once

#include "belt/belt_path.h"
#include "belt/press.h"
#include "belt/running_error.h"
#include "core/progress.h"

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace fettle {

/// Where the force acts: the pressure of the contact everywhere (Ren et al. 2006), or evenly over the rectangle about
/// the contact, which is Hammann's linear global model (1998): r = C_A K_A k_t V_b / (V_w L_w) F over the width L_w.
enum class BeltModel { local, global };

struct BeltOptions {
    PressOptions press;
    BeltModel model = BeltModel::local;
    double worn = 0;                     ///< work of the belt before, N mm
    bool keeps_losses = false;           ///< in BeltRun
    std::optional<ToleranceRange> range; ///< of the errors after each point; none: they are not kept
};

/// What happened at a contact point; NaN where the wheel is off the part.
struct BeltTrace {
    double time = 0; ///< since the start, at the point's end, s
    double duration = 0, force = 0, indentation = 0, peak_pressure = 0, area = 0;
    double removed = 0; ///< mm³, by the law over the contact
};

/// What a surfel lost at one point of the path, mm along its normal.
struct BeltLoss {
    Eigen::Index surfel;
    std::size_t point;
    double depth;
};

/// The errors of all surfels after a point of the path.
struct BeltError {
    Eigen::Index gouge = 0, within = 0, undercut = 0; ///< surfels
    double mean = 0, rms = 0, least = 0;              ///< mm
};

/// The account of a run.
struct BeltRun {
    std::vector<BeltTrace> trace;
    Eigen::VectorXd removed;       ///< of each surfel, mm along its normal
    double removed_volume = 0;     ///< mm³
    double work = 0;               ///< of the belt in this run, N mm (BeltLaw)
    Eigen::Index near_edge = 0;    ///< points whose contact is near the layer's free edge
    std::vector<BeltLoss> losses;  ///< point by point; empty unless they are kept
    std::vector<BeltError> errors; ///< of each point; empty unless they are kept
};

/// How far a run has come: all that its next point depends on, but for the surfels' displacements.
struct BeltState {
    std::size_t next = 0; ///< point of the path
    BeltRun run;
    std::optional<RunningError> error;
    PressMemory press;
};

/// Grinds along a path, point by point. At each the surfels that touch lose depth along their normals by the wheel's
/// law, in the time that half the ways to its neighbours take, and in the dwell; the others stay as they are. The law
/// gives the depth normal to the tangent plane, so that the pressure's sum is the force's work whatever the surfels'
/// normals (Ren et al. 2006, 4).
class BeltGrinding {
  public:
    /// All but the options are kept by reference.
    BeltGrinding(Surfels& surfels, const ContactWheel& wheel, const std::vector<BeltPoint>& path,
                 const BeltOptions& options);

    bool is_done() const { return state_.next == path_.size(); }
    /// The next point.
    /// @throws InputError naming the point if nothing is under the wheel, or the contact is not found
    void step();

    const BeltRun& run() const { return state_.run; }
    /// To go on from there later; the displacements are the surfels'.
    BeltState state() const;
    /// The surfels must have the displacements of that time.
    void go_on(BeltState state);

  private:
    void take(const Press& pressed, const Eigen::MatrixXd& depth, double duration);

    Surfels& surfels_;
    const ContactWheel& wheel_;
    const std::vector<BeltPoint>& path_;
    BeltOptions options_;
    Eigen::VectorXd way_;
    WheelPress press_;
    BeltState state_;
};

/// The whole path.
/// @throws InputError as BeltGrinding::step()
BeltRun grind(Surfels& surfels, const ContactWheel& wheel, const std::vector<BeltPoint>& path,
              const BeltOptions& options, const Progress& progress = {});

} // namespace fettle
