#pragma once

#include "robot/cell.h"

#include <Eigen/Core>

#include <cstddef>
#include <limits>
#include <vector>

namespace fettle {

/// Goes along a path of joints and keeps what it learns: a pair that was far apart is not looked at again before its
/// bodies have moved so far that they could be the nearest. What it tells does not depend on that.
class Walk {
  public:
    /// The cell must outlive it.
    explicit Walk(const Cell& cell);

    /// The least clearance with these joints, up to CollisionOptions::beyond.
    CellClearance step(const CellJoints& joints);
    /// The least on the way to the last step from the one before it: as check_path(). There must be two steps.
    CellClearance way();
    /// The next step does not follow the last one.
    void leave();

    std::size_t steps() const { return steps_; } ///< since it was left
    std::size_t looks() const { return looks_; } ///< between steps

  private:
    struct Place {
        CellJoints joints = CellJoints::Zero();
        Stance stance;
        std::vector<char> exact;     ///< of the pairs: or else the clearance is a lower bound
        std::vector<double> motions; ///< of the bodies on the way here; NaN: not asked for yet
    };
    void look(Place& place, std::size_t pair, double beyond);
    double motion(const Place& from, Place& to, std::size_t pair) const;
    CellClearance between(Place& from, Place& to, std::vector<std::size_t> some, std::size_t halvings);

    const Cell& cell_;
    Place before_, here_;
    std::vector<Place> middle_; ///< by the number of halvings
    std::vector<double> gone_;  ///< of the bodies: how far they have moved at most, mm
    std::vector<double> apart_; ///< of the pairs: a lower bound of the clearance, plus how far both had gone
    std::size_t last_ = 0;      ///< the pair that was least
    std::size_t steps_ = 0, looks_ = 0;
};

} // namespace fettle
