#pragma once

#include "plan/plan.h"
#include "station/record.h"

#include <Eigen/Core>

#include <optional>
#include <string>
#include <vector>

namespace fettle::station {

/// What a small picture in characters shows, in plan view: S as dots, B as hashes, recorded corners 1, 2, …, touches o,
/// the tool +; with a plan, inside B the standard deviation of the desired surface in tenths of the tolerance, 0 to 9.
struct SketchContent {
    const Record& record;
    const plan::Plan* plan = nullptr;
    std::optional<Eigen::Vector2d> tool; ///< M, mm
};

/// Lines of at most `columns` characters of ASCII; a character is twice as high as wide. X_m points to the right.
std::vector<std::string> sketch(const SketchContent& content, int columns, int rows);

} // namespace fettle::station
