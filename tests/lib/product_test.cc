// Products against Eigen's, of sizes that four lanes and pairs of columns divide, and of others.

#include "core/product.h"

#include <gtest/gtest.h>

#include <random>

namespace fettle {
namespace product_test {

Eigen::MatrixXd random_matrix(Eigen::Index rows, Eigen::Index columns)
{
    static std::mt19937 random(1);
    std::uniform_real_distribution<double> element(-1, 1);
    return Eigen::MatrixXd::NullaryExpr(rows, columns, [&] { return element(random); });
}

TEST(Product, IsThatOfEigen)
{
    constexpr double kRounding = 1e-14;
    for (const Eigen::Index rows : {0, 1, 3, 4, 8, 12, 16, 27, 170})
        for (const Eigen::Index inner : {0, 1, 30})
            for (const Eigen::Index columns : {0, 1, 2, 23}) {
                const Eigen::MatrixXd A = random_matrix(rows, inner), B = random_matrix(inner, columns);
                const Eigen::MatrixXd expected = A * B;
                EXPECT_TRUE(core::product(A, B).isApprox(expected, kRounding))
                    << rows << ' ' << inner << ' ' << columns;
            }
}

TEST(Product, TakesPartsOfMatrices)
{
    const Eigen::MatrixXd A = random_matrix(20, 20), B = random_matrix(20, 20);
    const Eigen::MatrixXd a = A.block(3, 2, 9, 7), b = B.block(5, 1, 7, 11);
    EXPECT_EQ(core::product(A.block(3, 2, 9, 7), B.block(5, 1, 7, 11)), core::product(a, b));
}

TEST(Product, TakesATransposedMatrixByItsStrides)
{
    const Eigen::MatrixXd A = random_matrix(13, 6), B = random_matrix(5, 6);
    Eigen::MatrixXd C(13, 5);
    core::multiply({A.data(), 13}, {B.data(), 5, 1}, 13, 6, 5, C.data(), 13);
    EXPECT_EQ(C, core::product(A, Eigen::MatrixXd(B.transpose())));
}

} // namespace product_test
} // namespace fettle
