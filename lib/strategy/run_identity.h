#pragma once

#include "plan/plan.h"
#include "removal/height_field.h"
#include "strategy/run.h"

#include <Eigen/Geometry>

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace fettle::strategy {

/// What a run that is continued must have in common with its beginning, part by part: its name, such as "job.wheel" or
/// "--stock", and a digest of it. The bounds of the plan may differ: a run that ended at one goes on with a larger one.
struct RunIdentity {
    struct Part {
        std::string name, digest;
        bool operator==(const Part&) const = default;
    };
    std::vector<Part> parts;
    cloud::Frame frame = cloud::Frame::part; ///< that the trace is labelled with
};

/// @param T_cell_job  where a robot finds the job; nothing: the machine has a frame of its own
RunIdentity identity_of(const plan::Plan& plan, const removal::HeightField& stock, Layer1 layer_1,
                        const std::optional<KnownRemoval>& known_removal,
                        const std::optional<Eigen::Isometry3d>& T_cell_job);

/// "NAME:DIGEST NAME:DIGEST …", without a line's end, and its inverse.
std::string to_text(const RunIdentity& identity);
RunIdentity parse_identity(std::string_view text);

/// Names of the parts that differ or that only one of two runs has, in the order of `a`; empty: the same run.
std::vector<std::string> differing_parts(const RunIdentity& a, const RunIdentity& b);

} // namespace fettle::strategy
