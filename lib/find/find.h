#pragma once

#include "core/constants.h"
#include "find/bounds.h"
#include "mesh/cloud_mesh.h"
#include "units/units.h"
#include "json/document.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <functional>
#include <string>
#include <vector>

namespace fettle::find {

/// An anomaly of a part. Lengths mm.
struct FoundAnomaly {
    int number = 0;          ///< row in the result and value of the field `anomaly`, from 1
    double probability = 0;  ///< that it is one, by the logistic model
    double score = 0;        ///< of the logistic model; without a reference
    int doubtful_others = 0; ///< doubtful finds of its view, which enter the probability, too
    double height = 0;       ///< largest over the surface beneath, along its mean normal
    double area = 0;         ///< of the surface beneath, mm²
    double volume = 0;       ///< over that surface, mm³
    double significance = 0; ///< height in standard deviations of the surface beneath
    std::string doubt;       ///< reason for an operator to check it; empty: none
    std::string job;         ///< file of its job; empty: it has none
    std::string wheel;       ///< why the wheel of its job is not the template's; empty: it is
    std::string like;        ///< file of the job of an earlier casting that has it, too; empty: none

    Eigen::Isometry3d T_anomaly_part; ///< its own frame: origin on the surface beneath, whose mean normal is +z
    Eigen::Matrix2Xd boundary;        ///< 2xN, polygon B in that frame's x-y plane, which encloses it
    Eigen::Matrix2Xd sampling;        ///< 2xM, polygon S around B in the same plane, on good metal
    double cell = 0;                  ///< of the height map: what the polygons resolve
    std::vector<Eigen::Index> points; ///< of the part, ascending
    Eigen::VectorXd heights;          ///< of these over the surface beneath
};

struct FindResult {
    double noise = 0;                    ///< standard deviation of the part's points, mm
    std::vector<FoundAnomaly> anomalies; ///< most probable first
    std::vector<std::string> absent; ///< files of jobs of an earlier casting whose anomalies this part does not have
};

struct FindOptions {
    SearchBounds bounds;
    double min_probability = 0.8; ///< less probable finds are left out
    /// Finds are kept, too, whose probability without signs of a feature by design (flat tops, others alike) is not
    /// below this.
    double min_by_evidence = core::kInfinity;
};

/// Finds anomalies of a part without a model: the metal around each candidate predicts the surface beneath it
/// (docs/methods/find.md).
/// @throws InputError if the part has no surface
FindResult find_anomalies(const mesh::CloudMesh& part, const FindOptions& options = {});

/// Signed distances from a reference of points of the part, mm, + material left; NaN: undefined.
using SignedDistances = std::function<Eigen::VectorXd(const Eigen::Matrix3Xd&)>;

/// Finds anomalies as local departures from a reference to which the part is registered. Slow departures (warp,
/// shrinkage, what the registration leaves) are taken for surface.
/// @throws InputError if the part has no surface, or the distances of all its points are undefined
FindResult find_anomalies_against(const mesh::CloudMesh& part, const SignedDistances& distances,
                                  const FindOptions& options = {});

/// Applies an operator's decisions: rows of `keep` are anomalies without doubt, rows of `drop` are none. Rows keep
/// their numbers.
/// @throws InputError for a number that is no row, or in both
void judge(FindResult& result, const std::vector<int>& keep, const std::vector<int>& drop);

/// The part with fields `anomaly` (0 none, else the row's number) and `height` (over the surface beneath, mm; 0 outside
/// of anomalies).
mesh::CloudMesh labelled(mesh::CloudMesh part, const FindResult& result);

/// Sets "kind", "units", "noise" and "anomalies" in a report. @param units  of its numbers
void set_report(json::Value& report, const FindResult& result, const units::Units& units);

} // namespace fettle::find
