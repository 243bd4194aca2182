#pragma once

#include "cloud/e57_pages.h"
#include "cloud/e57_scans.h"

#include <Eigen/Core>

namespace fettle::cloud {

/// Decodes the records of a scan (ASTM E2807-11, 9.3): data packets with a piece of each column's stream of bits.
/// @return  a row for each column, a column for each record
/// @throws InputError as parse_e57()
Eigen::MatrixXd read_e57_records(const E57Pages& pages, const E57Scan& scan, const std::string& source);

} // namespace fettle::cloud
