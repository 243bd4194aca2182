#pragma once

#include "cloud/cloud.h"
#include "core/progress.h"
#include "robot/avoid.h"
#include "robot/collision.h"
#include "robot/heterogeneous.h"
#include "robot/solve_path.h"
#include "units/units.h"
#include "json/document.h"

#include <memory>
#include <optional>
#include <string>

namespace fettle::robot {

struct CollisionRequest {
    PathArguments path;
    CollisionOptions collision;                ///< `model` is ignored
    std::optional<HeterogeneousOptions> model; ///< how the workpiece is represented; nothing: by all triangles
    std::optional<AvoidOptions> avoid;         ///< nothing: the path is left as it is
};

/// A path with its collisions, and with what was changed to avoid them.
struct CollisionStudy {
    CollisionRequest request;
    SolvedPath solved; ///< after the changes, as `checked`
    CheckedPath checked;
    CheckedPath before;                        ///< without the changes
    std::optional<AvoidedPath> avoided;        ///< the changes
    std::unique_ptr<HeterogeneousModel> model; ///< of the workpiece; null: all triangles
};

/// Solves the kinematics of a path, checks it for collisions, and avoids them if requested.
/// @param path  poses, or joints   @param source  its name for messages   @param mm  in the length unit of the path's
/// arguments
/// @param workpiece  nullptr: none; must outlive the result
/// @throws InputError as solve_path() and HeterogeneousModel, or for a model without a workpiece
CollisionStudy study_collisions(const Robot& robot, const cloud::Cloud& path, const std::string& source, double mm,
                                const Workpiece* workpiece, const CollisionRequest& request,
                                const core::Progress& progress);

/// Sets poses, joints, states and clearances of a path, and what was changed.
void set_fields(cloud::Cloud& path, const Robot& robot, const CollisionStudy& study);

/// Adds changes, kinematics and collisions of a path to a report.
/// @param times  at which the poses are reached, s; nothing: not known
/// @return  true if the robot can run the path without a collision
bool add_report(json::Value& report, const Robot& robot, const CollisionStudy& study,
                const std::optional<Eigen::VectorXd>& times, const units::Units& units);

} // namespace fettle::robot
