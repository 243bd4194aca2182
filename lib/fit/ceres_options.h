#pragma once

#include <ceres/solver.h>

namespace fettle {

/// What the fits share: dense QR (the prior of a nearly quadratic surface is stiff), one thread (same digits whatever
/// --threads), and silence: what the solver has to say is in its summary, its log would stand on stderr beside the
/// tool's one line.
ceres::Solver::Options quiet_dense_qr();

} // namespace fettle
