#pragma once

#include "job/job.h"
#include "removal/height_field.h"
#include "removal/preston.h"
#include "removal/wheel.h"

#include <Eigen/Core>

#include <vector>

namespace fettle::strategy {

/// Upper bound of the stock from the motion of the wheel: the lowest surface that its rim has swept. Where the wheel
/// has not been, it is the safe height inside B, where the anomaly's height is not known; outside B the metal is sound,
/// and no higher than the highest tool point of layer 1. Forces that it predicts are upper bounds, too.
class StockBound {
  public:
    /// @param sound_height  highest tool point of layer 1, z in mm
    StockBound(const job::Job& job, double sound_height);
    StockBound(const StockBound&) = delete;
    StockBound& operator=(const StockBound&) = delete;

    /// Lowers the bound to the rim of a wheel whose lowest line is at `tip` (frame M, mm).
    void lower(const Eigen::Vector3d& tip, double radius) { lower(tip, tip, radius); }
    /// Lowers the bound to the rim of a wheel that moves along a straight line.
    void lower(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double radius);

    /// Largest ratio of the stock's hardness to that of the job's removal coefficient.
    static constexpr double kMaxHardness = 2;
    /// Largest force while the wheel grinds along a polyline, N, if the stock is as high as the bound.
    /// @param path  commanded tool points, frame M; the wheel is at the first one   @param feed  mm/s
    /// @param hardness  of the stock, relative to that of the job's removal coefficient
    double max_force(const std::vector<Eigen::Vector3d>& path, double radius, double feed,
                     double hardness = kMaxHardness) const;
    /// Length of a polyline of commanded tool points, mm, up to where the bound is higher above the wheel's rim than
    /// `allowance`; the whole length if it nowhere is.
    double free_length(const std::vector<Eigen::Vector3d>& path, double radius, double allowance) const;
    /// Height at which the wheel moves from one place to another without contact, mm: the safe height if the path leads
    /// through B where the wheel has not been, or across a notch of B.
    double free_height(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double radius) const;

  private:
    bool is_outside_anomaly(const Eigen::Vector2d& xy) const;
    removal::HeightField cut_out(const std::vector<Eigen::Vector3d>& path, double radius) const;
    template <class Visit>
    void visit_positions(const Eigen::Vector3d& from, const Eigen::Vector3d& to, const Visit& visit) const;

    removal::HeightField bound_;
    Eigen::Array<bool, Eigen::Dynamic, Eigen::Dynamic> inside_; ///< for each cell: in B
    mutable removal::WheelInStock wheel_;                       ///< its position is not part of the bound's state
    removal::Spring spring_;
    Eigen::Matrix2d R_working_machine_;
    double width_;       ///< of the wheel, mm
    double removal_;     ///< removal coefficient of the job, mm³/(N s)
    double safe_height_; ///< z, mm
};

} // namespace fettle::strategy
