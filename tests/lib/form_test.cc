#include "compare/form.h"

#include "core/error.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace fettle {
namespace {

Eigen::Matrix3Xd five_points()
{
    Eigen::Matrix3Xd p(3, 5);
    p << 11.5, 18.5, 4.5, 25.5, 11.5, //
        7, 6.9, 13, 30, 37.5,         //
        1.1, 1.03, 1.02, 1.03, 1.02;
    return p;
}

// Reference: a published flatness case, least squares 0.0720973, minimum zone 0.0672621.
TEST(Form, FlatnessOfFivePoints)
{
    const Form f = form(FormKind::flatness, five_points());
    EXPECT_NEAR(f.least_squares.width, 0.0720973, 5e-8);
    EXPECT_NEAR(f.minimum_zone.width, 0.0672621, 5e-8);
    EXPECT_TRUE(f.minimum_zone.converged);
    EXPECT_EQ(f.minimum_zone.contacts.size(), 4U);
}

} // namespace
} // namespace fettle
