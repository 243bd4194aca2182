// The runner of run(), with its state between two actions. It is private to this module.

#pragma once

#include "plan/tool_path.h"
#include "strategy/contact_watch.h"
#include "strategy/feed_control.h"
#include "strategy/force_control.h"
#include "strategy/recorder.h"
#include "strategy/run.h"
#include "strategy/stock_bound.h"
#include "strategy/wheel_wear.h"

#include <optional>
#include <vector>

namespace fettle::strategy {

class Runner {
  public:
    Runner(const plan::Plan& plan, gantry::Gantry& gantry, const RunOptions& options);
    GrindRun run(const core::Progress& progress);

  private:
    LayerSwitching::Settings settings(const plan::Plan& plan) const;
    bool single_covering() const { return options_.layer_1 != Layer1::constant; }
    bool compensates_wear() const { return single_covering() || wear_model_.is_known(); }
    bool finishing(int layer) const { return layer == 1 && !strategy_.is_roughing(); }
    bool by_feed(int layer) const { return finishing(layer) && options_.layer_1 == Layer1::feed; }
    bool by_force(int layer) const { return finishing(layer) && options_.layer_1 == Layer1::force; }
    const Eigen::Vector3d& reference(const PathIndex& position) const
    {
        return path_.passes()[position.pass].points[position.point];
    }
    static Recorder::Mark mark(const Action& action, Event event) { return {action.layer, action.to.pass + 1, event}; }
    /// Height of the stock above the reference surface. A wheel whose wear is known is at its expected height, not as
    /// low as it is driven, lest it grind too deep. Control by feed and by force presses deeper where more is left, so
    /// that it takes the lower height.
    double remaining(const gantry::GantryStatus& status) const
    {
        const bool expects_wear = wear_model_.is_known() && !single_covering();
        const double higher = expects_wear ? wear_model_.expected_loss() - wheel_wear_ : 0;
        return status.deflection + height_error_ - force_offset_ + higher;
    }

    void fail(const Action& action, const gantry::GantryFault& fault);
    void retract(const Action& action);
    void grind_until_done(Action& action, const core::Progress& progress);
    void perform(const Action& action);
    void update_force_control(const Action& action);
    Eigen::Vector3d tool_point(int layer) const;
    void travel(const Action& action, const Eigen::Vector3d& reference);
    void grind(const Action& action, const Eigen::Vector3d& reference);
    void grind_at(const Action& action, double feed);
    void grind_controlled(const Action& action, const Eigen::Vector3d& reference);
    std::vector<Eigen::Vector3d> crossing_path(const PathIndex& to) const;
    static std::vector<Eigen::Vector3d> extended(std::vector<Eigen::Vector3d> path, double feed);
    Eigen::Vector3d path_deviation() const;
    double feed_to(const Action& action, const Eigen::Vector3d& reference);
    double feed_along_pass(const Action& action, const Eigen::Vector3d& reference) const;
    double feed_in_air(std::vector<Eigen::Vector3d> path) const;
    bool is_wall_ahead(double feed) const;
    double wall_slope() const;
    double force_after_step(double feed, double slope) const;
    double decisive_force() const;
    double max_force(std::vector<Eigen::Vector3d> path, int layer, double feed,
                     double hardness = StockBound::kMaxHardness) const;
    ForcePrediction force_on_passes(double hardness) const;
    void cross(const Action& action);
    void record_move(const gantry::GantryStatus& status, int layer, double feed);
    void lower_stock_bound(const gantry::GantryStatus& status, double feed);
    double radius() const;
    void resume_from_trace(const Action& action);
    void measure_wheel_if_due(const Action& action);
    void measure_wheel(const Action& action);
    double touch_off(const Action& action);

    const plan::Plan& plan_;
    RunOptions options_;
    Recorder machine_;
    plan::ToolPath path_;
    WheelWear wear_model_;
    LayerSwitching::Settings settings_; ///< by the members before it
    LayerSwitching strategy_;
    FeedControl feed_control_;
    ForceControl force_control_;
    std::optional<ContactWatch> contact_watch_;
    StockBound bound_;
    double climb_ = 0;                              ///< steepest slope that the wheel has climbed lately
    bool is_climbing_ = false;                      ///< on a wall, in the last step
    double feed_share_ = 1;                         ///< of the job's feed
    double crossing_share_ = 1;                     ///< of the job's feed, from one pass to the next
    Eigen::Vector3d tip_ = Eigen::Vector3d::Zero(); ///< the wheel's, at the end of the last move
    GrindRun result_;
    PathIndex at_;
    Eigen::Vector3d reference_point_ = Eigen::Vector3d::Zero(); ///< tool point in layer 1 at the tool's position
    double wheel_wear_ = 0;     ///< estimated since the last measurement, mm; 0 unless it is compensated
    double force_offset_ = 0;   ///< distance of the drives below the reference for the desired force, mm
    double impulse_ = 0;        ///< ∫F dt of the last step, N s
    Event event_ = Event::none; ///< of the next row
    double height_error_ = 0;   ///< distance of the drives above their target, mm
    double grinding_time_ = 0, last_touch_off_ = 0; ///< s, and its value at the last touch-off
    double last_time_ = 0, last_force_ = 0;         ///< of the machine at the end of the last move
    double last_feed_ = 0;                          ///< of the last move, mm/s; 0: it did not grind
};

} // namespace fettle::strategy
