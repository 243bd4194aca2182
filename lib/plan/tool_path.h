#pragma once

#include "job/job.h"
#include "plan/staircase.h"
#include "surface/surface.h"

#include <Eigen/Core>

#include <vector>

namespace fettle {

/// One pass as the machine drives it: places along it, and where its intervals begin.
struct ToolPass {
    double line = 0;                     ///< across, mm
    std::vector<double> along;           ///< of the touched points, ascending
    std::vector<int> starts;             ///< indices into `along`: the first point of each interval
    std::vector<Eigen::Vector3d> points; ///< tool points in layer 1, M
};

/// Tool points of a staircase (Wang 2007, 5.3.2: the points of the path are contact points; tool dimension and surface
/// normal are to be taken into account). Over every tool position the wheel rests on the surface: it touches it, and
/// cuts below it nowhere in its footprint. Layer n is the same path, raised.
class ToolPath {
  public:
    /// @param step  distance of neighbouring points, mm
    /// @throws InputError if the surface is not defined under a pass
    ToolPath(const Job& job, const Surface& surface, const std::vector<Pass>& passes, double step);

    /// Computes the points anew for a worn wheel. The number of points and `along` stay.
    void set_radius(double radius);

    const std::vector<ToolPass>& passes() const { return passes_; }
    /// Tool point for the middle of the wheel over (across, along), M.
    Eigen::Vector3d tool_point(const Eigen::Vector2d& across_along) const;
    /// The same frame for a point of M.
    Eigen::Vector2d across_along(const Eigen::Vector3d& point) const { return axes_.transpose() * point.head<2>(); }

  private:
    // Heights of the wheel's width on a line (or its arc, if it moves along its axis), at places along it.
    struct Profile {
        double origin, spacing;
        Eigen::VectorXd z;
        double at(double along) const;
    };
    struct Stretch {
        Profile profile;
        Interval touched;
        int pass, first, count;
    };
    Profile profile(double line, double from, double to) const;
    void fill(const Stretch& stretch);

    const Surface* surface_;
    Eigen::Matrix2d axes_; ///< columns: across, along, in M
    char axis_;
    double width_;
    WheelSections wheel_;
    std::vector<ToolPass> passes_;
    std::vector<Stretch> stretches_;
};

} // namespace fettle
