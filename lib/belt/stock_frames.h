#pragma once

#include "belt/assess.h"
#include "belt/surfel.h"
#include "draw/frames.h"

#include <optional>

namespace fettle::belt {

/// Draws surfels while they are ground, from where most of them face: gouge, within and undercut by a range, or without
/// one their displacements, in colours that end at the largest at first.
class SurfelPictures {
  public:
    SurfelPictures(const Surfels& surfels, const std::optional<ToleranceRange>& range);
    std::string picture(const Surfels& surfels, const std::string& title) const;

  private:
    std::optional<ToleranceRange> range_;
    Eigen::Vector3d towards_eye_;
    double scale_; ///< mm
};

} // namespace fettle::belt
