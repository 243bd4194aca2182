#pragma once

#include <Eigen/Core>

namespace fettle::core {

// Products of matrices by four numbers at a time where the processor has instructions for them: Eigen, compiled for
// all, uses two, and takes 1.7 times as long (tests/bench/libraries_bench.cc).

/// A matrix whose columns lie one after the other.
struct Columns {
    const double* data;
    Eigen::Index stride; ///< from a column to the next
};

/// A matrix, or its transposed.
struct Strided {
    const double* data;
    Eigen::Index row, column; ///< strides
};

/// C = A B.
/// @param rows  of A   @param inner  columns of A   @param columns  of B   @param stride  from a column of C to the
/// next
void multiply(const Columns& A, const Strided& B, Eigen::Index rows, Eigen::Index inner, Eigen::Index columns,
              double* C, Eigen::Index stride);

/// A B
Eigen::MatrixXd product(const Eigen::Ref<const Eigen::MatrixXd>& A, const Eigen::Ref<const Eigen::MatrixXd>& B);

} // namespace fettle::core
