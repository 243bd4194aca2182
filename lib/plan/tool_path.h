#pragma once

#include "job/job.h"
#include "plan/staircase.h"
#include "surface/surface.h"

#include <Eigen/Core>

#include <vector>

namespace fettle::plan {

/// The sampled points of one pass.
struct ToolPass {
    double line = 0;                     ///< position across the passes, mm
    std::vector<double> along;           ///< positions of the contacts along the pass, ascending, mm
    std::vector<int> starts;             ///< indices into `along`: first point of each interval
    std::vector<Eigen::Vector3d> points; ///< tool points in layer 1, frame M, mm
};

/// Tool points of a staircase (Wang 2007, 5.3.2: the points of the path are contact points; tool dimension and surface
/// normal are to be taken into account). At every tool point the wheel touches the surface and gouges it nowhere in its
/// footprint. Layer n is the same path, raised.
class ToolPath {
  public:
    /// @param surface  it must outlive this object   @param step  distance of neighbouring points, mm
    /// @throws InputError if the surface is not defined under a pass
    ToolPath(const job::Job& job, const surface::Surface& surface, const std::vector<Pass>& passes, double step);

    /// Recomputes the points for the radius of a worn wheel. The number of points and `along` do not change.
    void set_radius(double radius);

    const std::vector<ToolPass>& passes() const { return passes_; }
    /// Tool point when the middle of the wheel is above (across, along), frame M, mm.
    Eigen::Vector3d tool_point(const Eigen::Vector2d& across_along) const;
    /// Coordinates (across, along) of a point of the frame M.
    Eigen::Vector2d across_along(const Eigen::Vector3d& point) const { return axes_.transpose() * point.head<2>(); }

  private:
    // Height of the wheel's section across the passes on the surface, as uniform samples along a line.
    struct Profile {
        double origin, spacing;
        Eigen::VectorXd z;
        double at(double along) const;
    };
    // One interval of a pass, and the indices of its points: first to first + count - 1.
    struct ContactInterval {
        Profile profile;
        job::Interval contacts;
        int pass, first, count;
    };
    Profile profile(double line, double from, double to) const;
    void set_points(const ContactInterval& interval);

    const surface::Surface* surface_;
    Eigen::Matrix2d axes_; ///< columns: across, along, in M
    char axis_;
    double width_;
    WheelSections wheel_;
    std::vector<ToolPass> passes_;
    std::vector<ContactInterval> contact_intervals_;
};

} // namespace fettle::plan
