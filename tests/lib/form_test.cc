#include "compare/form.h"
#include "compare/sections.h"

#include "core/error.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace fettle {
namespace form_test {

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
    const compare::Form f = compare::evaluate_form(compare::FormKind::flatness, five_points());
    EXPECT_NEAR(f.least_squares.width, 0.0720973, 5e-8);
    EXPECT_NEAR(f.minimum_zone.width, 0.0672621, 5e-8);
    EXPECT_TRUE(f.minimum_zone.converged);
    EXPECT_EQ(f.minimum_zone.contacts.size(), 4U);
}

// Independent: the width of a body is smallest across a face or across two edges; so over all triples of points and all
// pairs of pairs.
TEST(Form, FlatnessByBruteForce)
{
    std::mt19937 random(1);
    std::uniform_real_distribution<double> place(-1, 1);
    for (int round = 0; round < 5; ++round) {
        Eigen::Matrix3Xd p = Eigen::Matrix3Xd::NullaryExpr(3, 16, [&] { return place(random); });
        p.row(2) *= 0.05;
        double min = 1;
        const auto try_direction = [&](const Eigen::Vector3d& across) {
            if (across.norm() < 1e-9) return; // parallel edges
            const Eigen::RowVectorXd d = across.normalized().transpose() * p;
            min = std::min(min, d.maxCoeff() - d.minCoeff());
        };
        for (int a = 0; a < 16; ++a)
            for (int b = 0; b < a; ++b)
                for (int c = 0; c < 16; ++c)
                    for (int d = 0; d < c; ++d)
                        try_direction(Eigen::Vector3d(p.col(a) - p.col(b)).cross(Eigen::Vector3d(p.col(c) - p.col(d))));
        const compare::Form f = compare::evaluate_form(compare::FormKind::flatness, p);
        EXPECT_NEAR(f.minimum_zone.width, min, 1e-12);
        EXPECT_GE(f.least_squares.width, f.minimum_zone.width);
    }
}

// Independent: the narrowest strip about points of a plane has an edge of theirs on one side; so over all pairs. The
// points also lie off their section, which must not count.
TEST(Form, StraightnessByBruteForce)
{
    std::mt19937 random(3);
    std::uniform_real_distribution<double> place(-1, 1);
    const Eigen::Vector3d section = Eigen::Vector3d(1, -2, 0.5).normalized(), along = section.unitOrthogonal();
    for (int round = 0; round < 5; ++round) {
        const Eigen::Matrix2Xd flat = Eigen::Vector2d(20, 0.05).asDiagonal() *
                                      Eigen::Matrix2Xd::NullaryExpr(2, 40, [&] { return place(random); });
        Eigen::Matrix3Xd p = along * flat.row(0) + section.cross(along) * flat.row(1);
        p += section * Eigen::RowVectorXd::NullaryExpr(40, [&] { return place(random); });
        double min = 1;
        for (int a = 0; a < 40; ++a)
            for (int b = 0; b < a; ++b) {
                const Eigen::Vector2d edge = (flat.col(a) - flat.col(b)).normalized();
                const Eigen::RowVectorXd d = Eigen::Vector2d(-edge.y(), edge.x()).transpose() * flat;
                min = std::min(min, d.maxCoeff() - d.minCoeff());
            }
        const compare::Form f = compare::evaluate_form(compare::FormKind::straightness, p, section);
        EXPECT_NEAR(f.minimum_zone.width, min, 1e-12);
        EXPECT_EQ(f.minimum_zone.contacts.size(), 3U);
        EXPECT_NEAR(f.least_squares.peak + f.least_squares.valley, f.least_squares.width, 1e-12);
        EXPECT_GE(f.least_squares.width, f.minimum_zone.width);
    }
}

// Points far off are named, and no others, although they are a tenth of all and pull at the first fit.
TEST(Form, OutliersAreLeftOut)
{
    std::mt19937 random(4);
    std::normal_distribution<double> noise(0, 0.01);
    Eigen::Matrix3Xd p(3, 2000);
    for (Eigen::Index i = 0; i < p.cols(); ++i) {
        const double turn = static_cast<double>(i % 100) / 60;
        const double r = 25 + noise(random) + (i % 10 == 3 ? 0.5 : 0);
        p.col(i) << r * std::sin(turn), static_cast<double>(i) / 40, r * std::cos(turn);
    }
    const std::vector<Eigen::Index> kept = compare::without_outliers(compare::FormKind::cylindricity, p, 6);
    EXPECT_EQ(kept.size(), 1800U);
    for (const Eigen::Index i : kept) EXPECT_NE(i % 10, 3);
}

TEST(Form, Sections)
{
    Eigen::Matrix3Xd p(3, 12);
    for (Eigen::Index i = 0; i < 12; ++i) p.col(i) << static_cast<double>(i % 4), 2.0 * static_cast<double>(i / 4), 5;
    const std::vector<compare::Section> along_x = compare::vertical_sections(p, 0, 2, 2);
    ASSERT_EQ(along_x.size(), 3U);
    EXPECT_EQ(along_x[1].offset, 2);
    EXPECT_EQ(along_x[1].points, (std::vector<Eigen::Index>{4, 5, 6, 7}));
    EXPECT_EQ(compare::vertical_sections(p, std::numbers::pi / 2, 1, 0.5).size(), 4U);
    EXPECT_THROW(compare::vertical_sections(p, 0, 1e-9, 1e-9), core::InputError);
}

Eigen::Matrix3Xd bumpy_cylinder()
{
    Eigen::Matrix3Xd p(3, 4000);
    for (int i = 0; i < p.cols(); ++i) {
        const double turn = i % 80 / 80.0 * 1.5, along = i / 80;
        const double r = 30 + 0.02 * std::sin(5 * turn + along) + 0.01 * std::cos(0.3 * along);
        p.col(i) << along, r * std::sin(turn), r * std::cos(turn);
    }
    return p;
}

// What a minimum zone is: all contacts touch, no point is outside, and no small motion makes it narrower.
TEST(Form, MinimumZoneHolds)
{
    const Eigen::Matrix3Xd p = bumpy_cylinder();
    for (const compare::FormKind kind :
         {compare::FormKind::cylindricity, compare::FormKind::sphericity, compare::FormKind::flatness}) {
        const compare::FormZone zone = compare::evaluate_form(kind, p).minimum_zone;
        EXPECT_TRUE(zone.converged);
        const Eigen::VectorXd d = compare::deviations(zone.element, p);
        EXPECT_NEAR(d.cwiseAbs().maxCoeff(), zone.width / 2, 1e-9);
        for (const Eigen::Index i : zone.contacts) EXPECT_NEAR(std::abs(d[i]), zone.width / 2, 1e-9);
        const compare::FormMotion motion(zone.element, 30);
        std::mt19937 random(2);
        std::normal_distribution<double> step(0, 1e-3);
        for (int i = 0; i < 300; ++i) {
            const compare::FormVector x =
                compare::FormVector::NullaryExpr(motion.parameter_count(), [&] { return step(random); });
            const Eigen::VectorXd moved = compare::deviations(motion.apply(x), p);
            EXPECT_GE(moved.maxCoeff() - moved.minCoeff(), zone.width - 1e-9);
        }
    }
}

TEST(Form, RigidMotionChangesNothing)
{
    const Eigen::Matrix3Xd p = bumpy_cylinder();
    const Eigen::Isometry3d motion =
        Eigen::Translation3d(300, -200, 10) * Eigen::AngleAxisd(1, Eigen::Vector3d(1, 2, 3).normalized());
    const compare::Form here = compare::evaluate_form(compare::FormKind::cylindricity, p),
                        there = compare::evaluate_form(compare::FormKind::cylindricity, motion * p);
    EXPECT_NEAR(here.least_squares.width, there.least_squares.width, 1e-9);
    EXPECT_NEAR(here.minimum_zone.width, there.minimum_zone.width, 1e-9);
    EXPECT_NEAR(
        std::abs((motion.linear() * here.least_squares.element.direction).dot(there.least_squares.element.direction)),
        1, 1e-12);
}

// The gradients against central differences.
TEST(Form, Gradients)
{
    const Eigen::Vector3d point(11, -7, 5);
    for (const compare::FormKind kind : {compare::FormKind::flatness, compare::FormKind::cylindricity,
                                         compare::FormKind::sphericity, compare::FormKind::straightness}) {
        const compare::FormElement element{
            kind, {1, 2, 3}, Eigen::Vector3d(1, -1, 2).normalized(), 10, Eigen::Vector3d(1, 1, 0).normalized()};
        const compare::FormMotion motion(element, 20);
        const compare::FormVector g = motion.gradient(point);
        for (Eigen::Index k = 0; k < g.size(); ++k) {
            constexpr double kStep = 1e-5; // rounding 1e-15 / 1e-5, truncation (1e-5)²
            compare::FormVector x = compare::FormVector::Zero(g.size());
            x[k] = kStep;
            const double up = compare::deviation(motion.apply(x), point),
                         down = compare::deviation(motion.apply(-x), point);
            EXPECT_NEAR(g[k], (up - down) / (2 * kStep), 1e-8);
        }
    }
}

TEST(Form, RefusesWhatDoesNotDetermineIt)
{
    const Eigen::Matrix3Xd line = Eigen::Vector3d(1, 2, 3) * Eigen::RowVectorXd::LinSpaced(10, 0, 1);
    for (const compare::FormKind kind :
         {compare::FormKind::flatness, compare::FormKind::cylindricity, compare::FormKind::sphericity}) {
        EXPECT_THROW(compare::evaluate_form(kind, line), core::InputError);
        EXPECT_THROW(compare::evaluate_form(kind, line.leftCols(1)), core::InputError);
        EXPECT_THROW(compare::evaluate_form(kind, Eigen::Matrix3Xd(3, 0)), core::InputError);
    }
}

} // namespace form_test
} // namespace fettle
