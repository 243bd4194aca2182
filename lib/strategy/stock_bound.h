#pragma once

#include "job/job.h"
#include "removal/height_field.h"
#include "removal/preston.h"
#include "removal/wheel.h"

#include <Eigen/Core>

#include <vector>

namespace fettle::strategy {

/// Upper bound of the stock, as the wheel itself has learnt it: the lowest surface that its rim swept where it has
/// been. Where it has not been, it is the safe height inside B, where anything may stand; outside B the metal is sound,
/// and no higher than the highest tool point of layer 1. What it predicts is no less than what the machine meets.
class StockBound {
  public:
    /// @param sound_height  highest tool point of layer 1, z in mm
    StockBound(const job::Job& job, double sound_height);
    StockBound(const StockBound&) = delete;
    StockBound& operator=(const StockBound&) = delete;

    /// The wheel's lowest line has been at `tip` (frame M, mm): the stock ends at its rim.
    void lower(const Eigen::Vector3d& tip, double radius) { lower(tip, tip, radius); }
    /// The wheel's lowest line has been at every tip along a straight line.
    void lower(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double radius);

    /// The stock may be that many times harder than the job's removal coefficient says.
    static constexpr double kMaxHardness = 2;
    /// Largest force while the wheel grinds along a polyline, N, if the stock stood as high as the bound.
    /// @param path  commanded tool points, frame M; the wheel is at the first one   @param feed  mm/s
    /// @param hardness  of the stock, relative to what the job says
    double max_force(const std::vector<Eigen::Vector3d>& path, double radius, double feed,
                     double hardness = kMaxHardness) const;
    /// How far the wheel goes along a polyline of commanded tool points before the bound stands higher above its rim
    /// than `allowance`, mm; the whole length if it nowhere does.
    double free_length(const std::vector<Eigen::Vector3d>& path, double radius, double allowance) const;
    /// Height at which the wheel moves from one place to another and touches nothing, mm: the safe height if it has to
    /// go where it has not been in B, or across a notch of B.
    double free_height(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double radius) const;

  private:
    bool is_off_the_work(const Eigen::Vector2d& xy) const;
    removal::HeightField cut_out(const std::vector<Eigen::Vector3d>& path, double radius) const;
    template <class Visit>
    void visit_positions(const Eigen::Vector3d& from, const Eigen::Vector3d& to, const Visit& visit) const;

    removal::HeightField bound_;
    Eigen::Array<bool, Eigen::Dynamic, Eigen::Dynamic> inside_; ///< for each cell: in B
    mutable removal::WheelInStock wheel_;                       ///< its place is no part of the bound
    removal::Spring spring_;
    Eigen::Matrix2d R_working_machine_;
    double width_;       ///< of the wheel, mm
    double removal_;     ///< as the job says, mm³/(N s)
    double safe_height_; ///< z, mm
};

} // namespace fettle::strategy
