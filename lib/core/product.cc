#include "core/product.h"

#include "core/simd.h"

namespace fettle::core {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
constexpr Index kLanes = 4;

/// kBlocks times four rows of kColumns columns of A B.
template <int kBlocks, int kColumns>
FETTLE_INLINE void product_block(const Columns& A, const Strided& B, Index inner, double* C, Index stride)
{
    Double4 sums[kBlocks][kColumns] = {};
    for (Index k = 0; k < inner; ++k)
#pragma GCC unroll 4 // keeps the sums in registers
        for (int j = 0; j < kColumns; ++j) {
            const Double4 factor = broadcast(B.data[k * B.row + j * B.column]);
#pragma GCC unroll 4
            for (int i = 0; i < kBlocks; ++i)
                sums[i][j] += *reinterpret_cast<const Double4*>(A.data + k * A.stride + i * kLanes) * factor;
        }
#pragma GCC unroll 4
    for (int j = 0; j < kColumns; ++j)
#pragma GCC unroll 4
        for (int i = 0; i < kBlocks; ++i) *reinterpret_cast<Double4*>(C + j * stride + i * kLanes) = sums[i][j];
}

template <int kColumns>
FETTLE_INLINE void product_of_columns(Columns A, const Strided& B, Index rows, Index inner, double* C, Index stride)
{
    const auto advance = [&](Index count) { A.data += count, C += count, rows -= count; };
    for (; rows >= 4 * kLanes; advance(4 * kLanes)) product_block<4, kColumns>(A, B, inner, C, stride);
    for (; rows >= 2 * kLanes; advance(2 * kLanes)) product_block<2, kColumns>(A, B, inner, C, stride);
    for (; rows >= kLanes; advance(kLanes)) product_block<1, kColumns>(A, B, inner, C, stride);
    for (Index i = 0; i < rows; ++i)
        for (int j = 0; j < kColumns; ++j) {
            double sum = 0;
            for (Index k = 0; k < inner; ++k) sum += A.data[k * A.stride + i] * B.data[k * B.row + j * B.column];
            C[j * stride + i] = sum;
        }
}

} // namespace

FETTLE_CLONES void multiply(const Columns& A, const Strided& B, Index rows, Index inner, Index columns, double* C,
                            Index stride)
{
    Index j = 0;
    for (; j + 2 <= columns; j += 2)
        product_of_columns<2>(A, {B.data + j * B.column, B.row, B.column}, rows, inner, C + j * stride, stride);
    if (j < columns)
        product_of_columns<1>(A, {B.data + j * B.column, B.row, B.column}, rows, inner, C + j * stride, stride);
}

MatrixXd product(const Eigen::Ref<const MatrixXd>& A, const Eigen::Ref<const MatrixXd>& B)
{
    MatrixXd result(A.rows(), B.cols());
    multiply({A.data(), A.outerStride()}, {B.data(), 1, B.outerStride()}, A.rows(), A.cols(), B.cols(), result.data(),
             A.rows());
    return result;
}

} // namespace fettle::core
