#pragma once

#include "compare/areas.h"
#include "compare/signed_distance.h"
#include "compare/test_points.h"

#include <Eigen/Core>

#include <memory>
#include <optional>

namespace fettle {

/// What must be known of all points before the first of them is compared. It is found out in the background, while
/// the reference is read and made ready.
class Survey {
  public:
    /// @param test  must outlive it   @param sampled  will some of the points be asked for?
    Survey(const TestPoints& test, const DistanceOptions& options, bool sampled);
    ~Survey();

    struct Found {
        Eigen::Matrix3Xd sample;       ///< points at equal distances in the file; none unless `sampled`
        std::optional<PlanAreas> plan; ///< of a cloud
        Eigen::VectorXd of_vertices;   ///< areas of a mesh's vertices, mm²
    };
    /// Waits for it. @throws InputError if the points cannot be read
    const Found& found();

  private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace fettle
