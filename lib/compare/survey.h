#pragma once

#include "compare/areas.h"
#include "compare/signed_distance.h"
#include "compare/test_points.h"

#include <Eigen/Core>

#include <memory>
#include <optional>

namespace fettle::compare {

/// Background pass over all points, for results that compare() needs before the first block. It runs while the
/// reference is read and indexed.
class Survey {
  public:
    /// @param test  must outlive the survey   @param sampled  whether results().sample is needed
    Survey(const TestPoints& test, const DistanceOptions& options, bool sampled);
    ~Survey();

    struct Results {
        Eigen::Matrix3Xd sample;             ///< points at equal steps through the file, mm; none unless `sampled`
        std::optional<PlanAreas> plan_areas; ///< of a cloud
        Eigen::VectorXd vertex_weights;      ///< volume_weights() of a mesh, mm²
    };
    /// Waits for the end of the pass. @throws InputError if the points cannot be read
    const Results& results();

  private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace fettle::compare
