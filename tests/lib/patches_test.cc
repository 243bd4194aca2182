#include "core/error.h"
#include "own_folder.h"
#include "surface/patches.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <numbers>
#include <string>

namespace fettle {
namespace patches_test {

std::string sample(const std::string& name)
{
    const char* samples = std::getenv("SAMPLES"); // set where the test runs in a folder of its own
    return (samples == nullptr ? "samples" : std::string(samples)) + "/parts/" + name;
}

/// A bicubic patch over [0, 30] x [0, 20], x and y linear in u and v, with the net of z = q(x) r(y) for quadratics
/// q(t) = r(t) = t²: the control value of t² over knots a b c is (ab + bc + ca) / 3 (blossom).
surface::Patch quadratic_patch()
{
    surface::Patch patch;
    patch.knots_u = Eigen::VectorXd(10);
    patch.knots_u << 0, 0, 0, 0, 10, 17, 30, 30, 30, 30;
    patch.knots_v = Eigen::VectorXd(8);
    patch.knots_v << 0, 0, 0, 0, 20, 20, 20, 20;
    const auto mean = [](const Eigen::VectorXd& t, Eigen::Index i) { return t.segment(i + 1, 3).mean(); };
    const auto square = [](const Eigen::VectorXd& t, Eigen::Index i) {
        return (t[i + 1] * t[i + 2] + t[i + 2] * t[i + 3] + t[i + 3] * t[i + 1]) / 3;
    };
    for (auto& coordinate : patch.control) coordinate.resize(6, 4);
    for (Eigen::Index i = 0; i < 6; ++i)
        for (Eigen::Index j = 0; j < 4; ++j) {
            patch.control[0](i, j) = mean(patch.knots_u, i);
            patch.control[1](i, j) = mean(patch.knots_v, j);
            patch.control[2](i, j) = square(patch.knots_u, i) * square(patch.knots_v, j);
        }
    return patch;
}

TEST(Patch, reproduces_quadratics_and_their_slopes)
{
    const surface::Patch patch = quadratic_patch();
    for (double x = 0; x <= 30; x += 2.5)
        for (double y = 0; y <= 20; y += 2.5) {
            const Eigen::Matrix3d here = surface::point_and_tangents(patch, {x, y});
            EXPECT_NEAR(here(0, 0), x, 1e-12);
            EXPECT_NEAR(here(2, 0), x * x * y * y, 1e-9);
            EXPECT_NEAR(here(2, 1), 2 * x * y * y, 1e-9);
            EXPECT_NEAR(here(2, 2), 2 * x * x * y, 1e-9);
            EXPECT_NEAR(surface::height(patch, {x, y}), x * x * y * y, 1e-9);
        }
}

TEST(Patch, is_not_defined_outside)
{
    const surface::Patch patch = quadratic_patch();
    for (const Eigen::Vector2d& xy : {Eigen::Vector2d(-0.001, 5), Eigen::Vector2d(30.001, 5),
                                      Eigen::Vector2d(5, 20.001), Eigen::Vector2d(500, -500), Eigen::Vector2d(NAN, 0)})
        EXPECT_TRUE(std::isnan(surface::height(patch, xy))) << xy.transpose();
}

// A quarter of a cylinder of radius 2 by the rational quadratic that is exactly a circle: u is not linear in x.
TEST(Patch, is_exact_for_a_rational_cylinder)
{
    surface::Patch patch;
    patch.degree_u = 2;
    patch.degree_v = 1;
    patch.knots_u = Eigen::VectorXd(6);
    patch.knots_u << 0, 0, 0, 1, 1, 1;
    patch.knots_v = Eigen::Vector4d(0, 0, 1, 1);
    for (auto& coordinate : patch.control) coordinate.resize(3, 2);
    patch.control[0] << 0, 0, 2, 2, 2, 2;
    patch.control[1] << 0, 5, 0, 5, 0, 5;
    patch.control[2] << 2, 2, 2, 2, 0, 0;
    patch.weights.setOnes(3, 2);
    patch.weights.row(1).setConstant(std::numbers::sqrt2 / 2);
    for (double x = 0; x < 1.99; x += 0.1)
        EXPECT_NEAR(surface::height(patch, {x, 3}), std::sqrt(4 - x * x), 1e-10) << x;
}

// The shipped patches: 5 x 4 in, x and y linear, and no quadric: a quadratic leaves more than ten touch errors.
TEST(Patch, samples_are_what_they_are_said_to_be)
{
    constexpr double inch = 25.4;
    for (const char* name : {"patch_concave.json", "patch_convex.json", "patch_saddle.json"}) {
        const surface::Patch patch = surface::read_patches(sample(name)).at(0);
        EXPECT_TRUE(std::isnan(surface::height(patch, {5.001 * inch, 2 * inch})));
        EXPECT_NEAR(surface::point_and_tangents(patch, {1.7, 2.3})(0, 0), 1.7 * inch, 1e-9);
        EXPECT_NEAR(surface::point_and_tangents(patch, {1.7, 2.3})(1, 0), 2.3 * inch, 1e-9);
        EXPECT_NEAR(surface::height(patch, {1.7 * inch, 2.3 * inch}),
                    surface::point_and_tangents(patch, {1.7, 2.3})(2, 0), 1e-9);
        // third differences of a quadratic vanish
        double largest = 0;
        for (double x = 0; x <= 2; x += 0.25) {
            const auto z = [&](double shift) { return surface::height(patch, {(x + shift) * inch, 2 * inch}); };
            largest = std::max(largest, std::abs(z(3) - 3 * z(2) + 3 * z(1) - z(0)));
        }
        EXPECT_GT(largest, 10 * 0.005 * inch) << name;
    }
}

/// Message of reading a patch with one piece of it replaced.
std::string refusal(const std::string& piece, const std::string& replacement)
{
    std::string text = R"({"kind": "patches", "units": {"length": "mm"}, "patches": [{"degree": [1, 1],
        "knots_u": [0, 0, 1, 1], "knots_v": [0, 0, 1, 1],
        "control": [[[0, 0, 1], [0, 1, 1]], [[1, 0, 1], [1, 1, 1]]], "weights": null}]})";
    if (!piece.empty()) text.replace(text.find(piece), piece.size(), replacement);
    const OwnFolder folder;
    const std::string path = "patch.json";
    std::ofstream(path) << text;
    try {
        surface::read_patches(path);
    } catch (const core::InputError& error) {
        return error.what();
    }
    return "";
}

TEST(Patch, refuses_bad_files_with_the_place)
{
    EXPECT_EQ(refusal("", ""), "");
    const auto expect_message = [](const std::string& message, const std::string& part) {
        EXPECT_NE(message.find(part), std::string::npos) << message;
    };
    expect_message(refusal("\"patches\", ", "\"job\", "), "kind");
    expect_message(refusal("[1, 1],", "[1, 9],"), "degree");
    expect_message(refusal("[1, 1],", "[2, 1],"), "patches[0].control");
    expect_message(refusal("\"knots_u\": [0, 0, 1, 1]", "\"knots_u\": [0, 0, 1]"), "patches[0].knots_u");
    expect_message(refusal("\"knots_u\": [0, 0, 1, 1]", "\"knots_u\": [0, 1, 0, 1]"), "patches[0].knots_u[2]");
    expect_message(refusal("\"knots_v\": [0, 0, 1, 1]", "\"knots_v\": [1, 1, 1, 1]"), "patches[0].knots_v");
    expect_message(refusal("[0, 1, 1]]", "[0, 1]]"), "patches[0].control[0][1]");
    expect_message(refusal("[0, 1, 1]]", "[0, 1, \"x\"]]"), "patches[0].control[0][1][2]");
    expect_message(refusal("[[1, 0, 1], ", "["), "patches[0].control");
    expect_message(refusal("null", "[[1, 1]]"), "patches[0].weights");
    expect_message(refusal("null", "[[1, 1], [1, 0]]"), "patches[0].weights");
    expect_message(refusal("\"weights\"", "\"wieghts\""), "wieghts");
}

} // namespace patches_test
} // namespace fettle
