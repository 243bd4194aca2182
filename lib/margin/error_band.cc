#include "margin/error_band.h"

#include <algorithm>

namespace fettle::margin {

double error_band(const Eigen::VectorXd& errors)
{
    return std::max(0.0, errors.maxCoeff()) - std::min(0.0, errors.minCoeff());
}

double shift_distance(const Eigen::VectorXd& errors) { return -errors.minCoeff(); }

} // namespace fettle::margin
