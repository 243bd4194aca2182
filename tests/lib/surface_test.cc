#include "surface/surface.h"

#include "core/error.h"
#include "surface/griddata.h"
#include "surface/precision.h"
#include "surface/revolution.h"
#include "surface/shapes.h"
#include "surface/surface_grid.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

namespace fettle {
namespace surface_test {

constexpr double kInch = 25.4;

surface::Bspline some_bspline()
{
    surface::Bspline spline{0.4, {-30, -20}, {11, 9}, Eigen::MatrixXd(9, 8)};
    for (Eigen::Index i = 0; i < spline.heights.size(); ++i)
        spline.heights.data()[i] = 5 * std::sin(1.7 * static_cast<double>(i)) + 0.1 * static_cast<double>(i);
    return spline;
}

surface::Cylinder some_cylinder(double curvature)
{
    const Eigen::Vector3d normal = Eigen::Vector3d(0.2, -0.3, 1).normalized();
    const Eigen::Vector3d axis = normal.cross(Eigen::Vector3d(0.5, 0.7, 0.1)).normalized();
    return {{3, -2, 7}, normal, axis, curvature};
}

surface::Sphere some_sphere(double curvature)
{
    return {{3, -2, 7}, Eigen::Vector3d(-0.3, 0.25, 1).normalized(), curvature};
}

surface::Cone some_cone(double around, double lean)
{
    const surface::Cylinder frame = some_cylinder(0);
    return {frame.point, frame.normal, frame.axis, around, lean};
}

surface::Torus some_torus(double around, double lean, double along)
{
    const surface::Cylinder frame = some_cylinder(0);
    return {frame.point, frame.normal, frame.axis, around, lean, along};
}

/// Its curvatures are those of no sphere, and change.
surface::Quadric some_quadric()
{
    Eigen::Matrix3d form;
    form << 9, 2, -1, 2, -7, 3, -1, 3, 12;
    return {{3, -2, 7}, Eigen::Vector3d(-0.3, 0.25, 1).normalized(), form / 1000};
}

std::vector<surface::Shape> some_shapes()
{
    return {surface::Plane{{2, -5}, 3, {0.4, -1.5}},
            some_sphere(1 / 90.0),
            some_sphere(-1 / 90.0),
            some_cylinder(1 / 70.0),
            some_cylinder(-1 / 70.0),
            some_cone(1 / 70.0, 0.4),
            some_cone(-1 / 70.0, -0.2),
            some_torus(1 / 70.0, 0.3, 1 / 200.0),
            some_torus(-1 / 150.0, -0.5, 1 / 60.0),
            some_torus(0, 0.1, 0),
            some_quadric(),
            surface::Polynomial{{3, -2}, 20, Eigen::VectorXd::LinSpaced(10, -3, 4)},
            surface::Swept{{1, 2}, Eigen::Vector2d(0.6, 0.8), 25, {1, -2, 3, 0.5}, 0.2, -25, 25},
            some_bspline()};
}

/// Best agreement of a derivative with central differences over several steps: too large truncates, too small rounds.
double difference_error(const std::function<double(double)>& f, double derivative)
{
    double best = std::numeric_limits<double>::infinity();
    for (const double h : {1e-2, 1e-3, 1e-4, 1e-5})
        best = std::min(best, std::abs((f(h) - f(-h)) / (2 * h) - derivative));
    return best;
}

/// A cone or torus with parameter j changed.
template <typename Revolution>
Revolution changed_revolution(const Revolution& shape, Eigen::Index j, double by)
{
    Revolution result = shape;
    const Eigen::Vector3d across = shape.normal.cross(shape.axis);
    if (j == 0) result.point += by * shape.normal;
    if (j == 1) result.normal = (shape.normal + by * across).normalized();
    if (j == 2) {
        result.normal = (shape.normal + by * shape.axis).normalized();
        result.axis = (shape.axis - by * shape.normal).normalized();
    }
    if (j == 3) result.axis = (shape.axis + by * across).normalized();
    if (j == 4) result.curvature_around += by;
    if (j == 5) result.lean += by;
    return result;
}

/// The shape with θ_j changed by `by`, in the parameters that surface.h states.
surface::Shape changed(const surface::Shape& shape, Eigen::Index j, double by)
{
    if (const surface::Plane* plane = std::get_if<surface::Plane>(&shape)) {
        surface::Plane result = *plane;
        (j == 0 ? result.z0 : result.slope[j - 1]) += by;
        return result;
    }
    if (const surface::Sphere* sphere = std::get_if<surface::Sphere>(&shape)) {
        surface::Sphere result = *sphere;
        if (j == 0) result.point += by * sphere->normal;
        if (j == 1 || j == 2) result.normal += by * surface::tangents(sphere->normal)[static_cast<std::size_t>(j - 1)];
        result.normal.normalize();
        if (j == 3) result.curvature += by;
        return result;
    }
    if (const surface::Cylinder* cylinder = std::get_if<surface::Cylinder>(&shape)) {
        surface::Cylinder result = *cylinder;
        const Eigen::Vector3d across = cylinder->axis.cross(cylinder->normal);
        if (j == 0) result.point += by * cylinder->normal;
        if (j == 1) result.normal = (cylinder->normal + by * across).normalized();
        if (j == 2) {
            result.normal = (cylinder->normal - by * cylinder->axis).normalized();
            result.axis = (cylinder->axis + by * cylinder->normal).normalized();
        }
        if (j == 3) result.axis = (cylinder->axis + by * across).normalized();
        if (j == 4) result.curvature += by;
        return result;
    }
    if (const surface::Cone* cone = std::get_if<surface::Cone>(&shape)) return changed_revolution(*cone, j, by);
    if (const surface::Torus* torus = std::get_if<surface::Torus>(&shape)) {
        surface::Torus result = changed_revolution(*torus, j, by);
        if (j == 6) result.curvature_along += by;
        return result;
    }
    if (const surface::Quadric* quadric = std::get_if<surface::Quadric>(&shape)) {
        surface::Quadric result = *quadric;
        Eigen::Matrix3d frame;
        frame << surface::tangents(quadric->normal)[0], surface::tangents(quadric->normal)[1], quadric->normal;
        if (j == 0) result.point += by * quadric->normal;
        if (j == 1 || j == 2) result.normal = (quadric->normal + by * frame.col(j - 1)).normalized();
        const Eigen::Index row = j < 4 ? 0 : j < 6 ? 1 : 2, column = j - 3 - row * (row + 1) / 2;
        Eigen::Matrix3d change = Eigen::Matrix3d::Zero();
        if (j >= 3) change(row, column) = change(column, row) = by;
        result.form += frame * change * frame.transpose();
        return result;
    }
    if (const surface::Polynomial* polynomial = std::get_if<surface::Polynomial>(&shape)) {
        surface::Polynomial result = *polynomial;
        result.coefficients[j] += by;
        return result;
    }
    if (const surface::Swept* swept = std::get_if<surface::Swept>(&shape)) {
        surface::Swept result = *swept;
        (j < 4 ? result.section[j] : result.slope) += by;
        return result;
    }
    surface::Bspline result = std::get<surface::Bspline>(shape);
    result.heights.data()[j] += by;
    return result;
}

const Eigen::Vector2d kPlaces[] = {{3, -2}, {10, 4}, {-7, 11}, {0, 0}};

TEST(Surface, GradientsAgreeWithDifferences)
{
    for (const surface::Shape& shape : some_shapes()) {
        const Eigen::VectorXi powers = surface::parameter_powers(shape);
        for (const Eigen::Vector2d& xy : kPlaces) {
            const Eigen::VectorXd gradient = surface::height_gradients(shape, xy).col(0);
            ASSERT_EQ(gradient.size(), powers.size());
            for (Eigen::Index j = 0; j < gradient.size(); ++j) {
                // Curvatures are of the order of 1/100: their step is smaller by as much.
                const double unit = powers[j] < 0 ? 1e-3 : 1;
                const auto along = [&](double h) {
                    surface::Surface surface;
                    surface.shape = changed(shape, j, unit * h);
                    return surface::height(surface, xy);
                };
                EXPECT_LT(difference_error(along, unit * gradient[j]), 1e-8 * (1 + std::abs(unit * gradient[j])))
                    << "shape " << shape.index() << ", parameter " << j;
            }
        }
    }
}

TEST(Surface, NormalsAgreeWithDifferences)
{
    for (const surface::Shape& shape : some_shapes()) {
        surface::Surface surface;
        surface.shape = shape;
        for (const Eigen::Vector2d& xy : kPlaces) {
            const Eigen::Vector3d n = surface::normal(surface, xy);
            EXPECT_NEAR(n.norm(), 1, 1e-15);
            for (int axis = 0; axis < 2; ++axis) {
                const auto along = [&](double h) {
                    return surface::height(surface, xy + h * Eigen::Vector2d::Unit(axis));
                };
                EXPECT_LT(difference_error(along, -n[axis] / n.z()), 1e-8) << "shape " << shape.index();
            }
        }
    }
}

TEST(Surface, SphereAndCylinderByCentreAndRadius)
{
    // z = cz ± √(R² - r²), exactly.
    for (const bool convex : {true, false}) {
        const double side = convex ? 1 : -1;
        const surface::Sphere sphere = surface::sphere_from_centre({1, 2, 3}, 50, convex);
        EXPECT_NEAR(surface::height(sphere, {31, 2}), 3 + side * 40, 1e-12);
        EXPECT_TRUE(std::isnan(surface::height(sphere, {52, 2})));
        EXPECT_LT((sphere.point - sphere.normal / sphere.curvature - Eigen::Vector3d(1, 2, 3)).norm(), 1e-12);
        EXPECT_NEAR(std::abs(1 / sphere.curvature), 50, 1e-12);

        const surface::Cylinder cylinder = surface::cylinder_from_axis({1, 2, 3}, {0, 3, 4}, 50, convex);
        // Across the axis at its own height: the section is a circle.
        EXPECT_NEAR(surface::height(cylinder, {31, 2}), 3 + side * 40 / 0.6, 1e-12);
        // Along the axis the height rises by 4/3.
        EXPECT_NEAR(surface::height(cylinder, {31, 5}) - surface::height(cylinder, {31, 2}), 4, 1e-12);
        EXPECT_TRUE(std::isnan(surface::height(cylinder, {52, 2})));
    }
}

/// Distances of many points are those of each alone, to the last digit. @return  number of points without a distance
int expect_distances_of_each(const surface::RevolutionParameters& theta, const Eigen::MatrixX3d& points)
{
    const surface::Revolution revolution = surface::make_revolution(theta);
    Eigen::VectorXd values(points.rows()), again = values;
    surface::RevolutionJacobian jacobian(points.rows(), surface::kRevolutionParameterCount);
    surface::distances(revolution, points, values.data(), &jacobian);
    surface::distances(revolution, points, again.data(), nullptr);
    int without = 0;
    for (Eigen::Index i = 0; i < points.rows(); ++i) {
        const surface::RevolutionDistance alone = surface::distance_with_gradients(revolution, points.row(i));
        if (std::isnan(alone.value)) {
            EXPECT_TRUE(std::isnan(values[i]) && std::isnan(again[i]));
            ++without;
            continue;
        }
        EXPECT_EQ(values[i], alone.value);
        EXPECT_EQ(again[i], alone.value);
        EXPECT_EQ(jacobian.row(i).transpose(), alone.parameter_gradient);
    }
    return without;
}

// Four at once, and those that remain.
TEST(Surface, ManyDistancesFromARevolution)
{
    std::mt19937 random(1);
    std::uniform_real_distribution<double> coordinate(-1, 1);
    for (int draw = 0; draw < 50; ++draw) {
        const auto theta = surface::RevolutionParameters::NullaryExpr([&] { return coordinate(random); });
        expect_distances_of_each(theta,
                                 Eigen::MatrixX3d::NullaryExpr(draw % 12, 3, [&] { return coordinate(random); }));
    }
}

// The centre of a sphere has none, whichever point it is.
TEST(Surface, ManyDistancesWithoutThatOfTheCentre)
{
    surface::RevolutionParameters sphere = surface::RevolutionParameters::Zero();
    sphere[surface::kCurvatureAround] = sphere[surface::kCurvatureAlong] = -1;
    for (const Eigen::Index at : {1, 3, 4, 5}) {
        Eigen::MatrixX3d points = Eigen::MatrixX3d::Constant(6, 3, 0.25);
        points.row(at) << 0, 0, 1;
        EXPECT_EQ(expect_distances_of_each(sphere, points), 1);
    }
}

// Against the implicit equations of a cone and a torus about an axis of revolution w through c.
TEST(Surface, ConeAndTorusLieAboutTheirAxis)
{
    for (const double side : {1.0, -1.0})
        for (const double lean : {0.3, -0.6}) {
            const surface::Cone cone = some_cone(side / 80, lean);
            const Eigen::Vector3d w = std::sin(lean) * cone.normal + std::cos(lean) * cone.axis;
            const Eigen::Vector3d m = std::cos(lean) * cone.normal - std::sin(lean) * cone.axis; // from the axis
            const Eigen::Vector3d c = cone.point - m / cone.curvature_around;
            const surface::Torus torus = {cone.point, cone.normal, cone.axis, cone.curvature_around, lean, side / 30};
            const Eigen::Vector3d ring = torus.point - torus.normal / torus.curvature_along; // a point of its ring
            const double ring_radius = std::abs((ring - c).dot(m)), ring_height = (ring - c).dot(w);
            for (const Eigen::Vector2d& xy : kPlaces) {
                const Eigen::Vector3d p = Eigen::Vector3d(xy.x(), xy.y(), surface::height(cone, xy)) - c;
                const double from_axis = (p - p.dot(w) * w).norm();
                EXPECT_NEAR(from_axis, 80 - side * std::tan(lean) * p.dot(w), 1e-11);
                const Eigen::Vector3d q = Eigen::Vector3d(xy.x(), xy.y(), surface::height(torus, xy)) - c;
                EXPECT_NEAR(std::hypot((q - q.dot(w) * w).norm() - ring_radius, q.dot(w) - ring_height), 30, 1e-11);
            }
        }
}

TEST(Surface, ConesAndToriHoldCylindersAndSpheres)
{
    const surface::Cylinder cylinder = some_cylinder(1 / 70.0);
    const surface::Sphere sphere = {cylinder.point, cylinder.normal, -1 / 70.0};
    for (const Eigen::Vector2d& xy : kPlaces) {
        EXPECT_NEAR(surface::height(some_cone(1 / 70.0, 0), xy), surface::height(cylinder, xy), 1e-12);
        EXPECT_NEAR(surface::height(some_torus(-1 / 70.0, 0, -1 / 70.0), xy), surface::height(sphere, xy), 1e-12);
    }
}

TEST(Surface, QuadricsHoldSpheresCylindersAndPlanes)
{
    const surface::Sphere sphere = some_sphere(1 / 90.0);
    const surface::Cylinder cylinder = some_cylinder(-1 / 70.0);
    const Eigen::Matrix3d one = Eigen::Matrix3d::Identity();
    const Eigen::Matrix3d across = one - cylinder.axis * cylinder.axis.transpose();
    const Eigen::Vector3d u(0.01, -0.02, 0.005);
    const Eigen::Matrix3d pair = u * sphere.normal.transpose() + sphere.normal * u.transpose(); // n·d (1 + u·d)
    for (const Eigen::Vector2d& xy : kPlaces) {
        EXPECT_NEAR(surface::height(surface::Quadric{sphere.point, sphere.normal, one / 90}, xy),
                    surface::height(sphere, xy), 1e-12);
        EXPECT_NEAR(surface::height(surface::Quadric{cylinder.point, cylinder.normal, across / -70}, xy),
                    surface::height(cylinder, xy), 1e-12);
        EXPECT_NEAR(surface::height(surface::Quadric{sphere.point, sphere.normal, pair}, xy),
                    surface::height(surface::Sphere{sphere.point, sphere.normal, 0}, xy), 1e-12);
    }
}

// The mean of a mixture, its variance within and between, and its slope.
TEST(Surface, IsTheMeanOfItsAlternatives)
{
    surface::Surface surface;
    surface.shape = surface::Plane{{0, 0}, 1, {0.1, 0}};
    surface.covariance = Eigen::Vector3d(0.04, 0, 0).asDiagonal();
    surface.weight = 0.75;
    surface.alternatives = {
        {"other", 0, 0.25, surface::Plane{{0, 0}, 3, {0.5, 0.2}}, Eigen::Vector3d(0.16, 0, 0).asDiagonal()},
        {"unlikely", 9, 0, {}, {}}};
    EXPECT_NEAR(surface::height(surface, {2, 0}), 0.75 * 1.2 + 0.25 * 4, 1e-15);
    const double spread = 0.75 * std::pow(1.2 - 1.9, 2) + 0.25 * std::pow(4 - 1.9, 2);
    EXPECT_NEAR(surface::sigma(surface, {2, 0}), std::sqrt(0.75 * 0.04 + 0.25 * 0.16 + spread), 1e-15);
    const Eigen::Vector3d n = surface::normal(surface, {2, 0});
    EXPECT_NEAR(-n.x() / n.z(), 0.2, 1e-15);
    EXPECT_NEAR(-n.y() / n.z(), 0.05, 1e-15);
    surface.touches = Eigen::Matrix3Xd::Zero(3, 4);
    surface.roles = Eigen::VectorXi::Ones(4);
    surface.outliers = {1, 3};
    const surface::Surface back =
        surface::parse_surface(json::Reader::parse(surface::to_json(surface).text(), "s.json"));
    EXPECT_EQ(back.outliers, surface.outliers);
    EXPECT_EQ(back.alternatives.size(), 2U);
    EXPECT_EQ(surface::height(back, {2, 0}), surface::height(surface, {2, 0}));
    EXPECT_EQ(surface::sigma(back, {2, 0}), surface::sigma(surface, {2, 0}));
    surface.weight = 0.7;
    try {
        surface::parse_surface(json::Reader::parse(surface::to_json(surface).text(), "s.json"));
        FAIL();
    } catch (const core::InputError& error) {
        EXPECT_STREQ(error.what(), "s.json: alternatives: weights do not sum up to 1 with that of the fit");
    }
}

TEST(Surface, FlatSphereIsAPlane)
{
    const surface::Sphere flat = some_sphere(0);
    const surface::Plane plane{flat.point.head<2>(), flat.point.z(), -flat.normal.head<2>() / flat.normal.z()};
    for (const Eigen::Vector2d& xy : kPlaces) {
        EXPECT_NEAR(surface::height(flat, xy), surface::height(plane, xy), 1e-14);
        EXPECT_NEAR(surface::height(some_sphere(1e-12), xy), surface::height(plane, xy), 1e-9); // sag r²/2R
    }
}

TEST(Surface, BsplineOfLinearControlsIsLinear)
{
    surface::Bspline spline = some_bspline();
    for (Eigen::Index j = 0; j < spline.heights.cols(); ++j)
        for (Eigen::Index i = 0; i < spline.heights.rows(); ++i)
            spline.heights(i, j) = 2 + 3 * static_cast<double>(i - 1) - 4 * static_cast<double>(j - 1);
    for (const Eigen::Vector2d& xy : kPlaces) {
        const Eigen::Vector2d uv =
            (Eigen::Rotation2Dd(-spline.angle) * (xy - spline.origin)).cwiseQuotient(spline.cell);
        EXPECT_NEAR(surface::height(spline, xy), 2 + 3 * uv.x() - 4 * uv.y(), 1e-12);
    }
    const Eigen::Vector2d far = Eigen::Rotation2Dd(spline.angle) * Eigen::Vector2d(6 * 11, 5 * 9) + spline.origin;
    EXPECT_NEAR(surface::height(spline, far), 2 + 18 - 20, 1e-12); // the last corner belongs to it
    EXPECT_TRUE(std::isnan(surface::height(spline, far + Eigen::Vector2d(1, 1))));
}

surface::Surface with_everything(const surface::Shape& shape, units::Units::Length unit)
{
    surface::Surface surface;
    surface.units.length = unit;
    surface.shape = shape;
    surface.shift = 0.123;
    surface.method = "some";
    const Eigen::Index n = surface::parameter_powers(shape).size();
    const Eigen::MatrixXd root = Eigen::MatrixXd::NullaryExpr(
        n, n, [](Eigen::Index i, Eigen::Index j) { return std::cos(1.0 + static_cast<double>(3 * i + 7 * j)); });
    surface.covariance = root * root.transpose();
    surface.touch_sigma = 0.05;
    surface.touch_sigma_dof = 6;
    surface.rms = 0.03;
    surface.goodness = 0.7;
    surface.touches.resize(3, 2);
    surface.touches << 1, 2, 3, 4, 5, 6;
    surface.roles = Eigen::Vector2i(1, 5);
    surface.ignored = 3;
    surface.prediction = surface::Prediction{"posterior", 0.99, 0.4, 0.2, true};
    return surface;
}

TEST(SurfaceJson, RoundTripInAnyUnit)
{
    for (const surface::Shape& shape : some_shapes())
        for (const units::Units::Length unit : {units::Units::Length::mm, units::Units::Length::in}) {
            const surface::Surface surface = with_everything(shape, unit);
            const surface::Surface back =
                surface::parse_surface(json::Reader::parse(surface::to_json(surface).text(), "test"));
            EXPECT_EQ(back.shape.index(), shape.index());
            for (const Eigen::Vector2d& xy : kPlaces) {
                EXPECT_NEAR(surface::height(back, xy), surface::height(surface, xy), 1e-12);
                EXPECT_NEAR(surface::sigma(back, xy) / surface::sigma(surface, xy), 1, 1e-12);
            }
            EXPECT_LT((back.touches - surface.touches).norm(), 1e-12);
            EXPECT_EQ(back.roles, surface.roles);
            EXPECT_NEAR(back.touch_sigma, 0.05, 1e-15);
            EXPECT_EQ(back.touch_sigma_dof, 6);
            EXPECT_NEAR(back.rms, 0.03, 1e-15);
            EXPECT_EQ(back.goodness, 0.7);
            EXPECT_EQ(back.ignored, 3);
            EXPECT_EQ(back.method, "some");
            ASSERT_TRUE(back.prediction.has_value());
            EXPECT_NEAR(back.prediction->band, 0.4, 1e-15);
            EXPECT_TRUE(back.prediction->clamped);
        }
}

TEST(SurfaceJson, UnitsAreTheFiles)
{
    surface::Surface surface;
    surface.units.length = units::Units::Length::in;
    surface.shape = surface::sphere_from_centre({0, 0, 0}, 4 * kInch, true);
    json::Reader shape = json::Reader::parse(surface::to_json(surface).text(), "test").object("shape");
    EXPECT_NEAR(shape.number("curvature"), 0.25, 1e-15);
    EXPECT_NEAR(shape.vector("point")[2], 4, 1e-15);
}

std::string refusal(const std::string& text)
{
    try {
        surface::parse_surface(json::Reader::parse(text, "s.json"));
    } catch (const core::InputError& error) {
        return error.what();
    }
    return "";
}

std::string surface_text(const std::string& shape, const std::string& more = "")
{
    return R"({"kind": "surface", "units": {"length": "mm"}, "shape": )" + shape + more + "}";
}

TEST(SurfaceJson, RefusesWhatIsWrong)
{
    const std::string plane = R"({"type": "plane", "origin": [0, 0], "z0": 1, "slope": [0, 0]})";
    EXPECT_EQ(refusal(surface_text(plane)), "");
    EXPECT_EQ(refusal(surface_text(plane, R"(, "covariance": [1, 0, 1])")),
              "s.json: covariance: expected 6 numbers, got 3");
    EXPECT_EQ(refusal(surface_text(plane, R"(, "covariance": [-1, 0, 1, 0, 0, 1])")),
              "s.json: covariance: has a negative variance");
    EXPECT_EQ(refusal(surface_text(plane, R"(, "touches": [[1, 2, 3, 9]])")),
              "s.json: touches[0][3]: is no touch role (0 to 5)");
    EXPECT_EQ(refusal(surface_text(plane, R"(, "shiftt": 1)")), "s.json: shiftt: unknown key, did you mean \"shift\"?");
    EXPECT_EQ(refusal(surface_text(R"({"type": "plan", "origin": [0, 0], "z0": 1, "slope": [0, 0]})")),
              "s.json: shape.type: \"plan\" is none of plane, sphere, cylinder, cone, torus, quadric, polynomial, "
              "swept, bspline, "
              "tensor-bspline, griddata; did you mean \"plane\"?");
    EXPECT_EQ(refusal(surface_text(R"({"type": "sphere", "point": [0, 0, 0], "normal": [0, 0, 2], "curvature": 0})")),
              "s.json: shape.normal: must have length 1");
    EXPECT_EQ(refusal(surface_text(R"({"type": "sphere", "point": [0, 0, 0], "normal": [0, 0, -1], "curvature": 0})")),
              "s.json: shape.normal: must point up");
    EXPECT_EQ(refusal(surface_text(R"({"type": "bspline", "angle_deg": 0, "origin": [0, 0], "cell": [1, 1],
                                      "heights": [[1, 1, 1], [1, 1, 1], [1, 1, 1], [1, 1, 1]]})")),
              "s.json: shape.heights: expected at least 4 rows of 4 (one cubic cell)");
    EXPECT_EQ(refusal(surface_text(R"({"type": "bspline", "angle_deg": 0, "origin": [0, 0], "cell": [1, 0],
                                      "heights": [[1, 1, 1, 1], [1, 1, 1, 1], [1, 1, 1, 1], [1, 1, 1, 1]]})")),
              "s.json: shape.cell: must be positive");
    EXPECT_EQ(
        refusal(surface_text(R"({"type": "polynomial", "origin": [0, 0], "scale": 1, "coefficients": [1, 2, 3, 4]})")),
        "s.json: shape.coefficients: expected 1, 3, 6, 10, … numbers: all of a total degree");
    EXPECT_EQ(refusal(surface_text(plane, R"(, "precision": {"amplitude": 1, "weights": [[1]]})")),
              "s.json: precision: belongs to a shape of type bspline");
    EXPECT_EQ(
        refusal(surface_text(
            plane, R"(, "fit": {"method": "plane", "touch_sigma": 1, "rms": 1, "ignored": 0, "outliers": [1, 1.5]})")),
        "s.json: fit.outliers: 1.5 is not the index of a touch");
}

TEST(SurfaceGrid, CoversTheOutlineOnce)
{
    job::Polygon square(2, 4);
    square << 0, 10, 10, 0, 0, 0, 5, 5;
    const surface::SurfaceGrid grid = surface::make_surface_grid(square, 0.3, 2.5);
    ASSERT_EQ(grid.xy.cols(), 5 * 3);
    ASSERT_EQ(grid.triangles.cols(), 2 * 4 * 2);
    surface::Surface surface;
    surface.shape = surface::Plane{{0, 0}, 1, {0, 0}};
    const mesh::Mesh mesh = surface::mesh_of(surface, grid);
    double total = 0;
    for (Eigen::Index i = 0; i < mesh.triangles.cols(); ++i) {
        const Eigen::Vector3d a = mesh.vertices.col(mesh.triangles(0, i));
        total +=
            (mesh.vertices.col(mesh.triangles(1, i)) - a).cross(mesh.vertices.col(mesh.triangles(2, i)) - a).z() / 2;
    }
    EXPECT_NEAR(total, 50, 1e-12);
    // Aligned with the turned frame: the second point is one step along its x axis.
    EXPECT_LT((grid.xy.col(1) - 2.5 * Eigen::Vector2d(std::cos(0.3), std::sin(0.3))).norm(), 1e-12);
    EXPECT_THROW(surface::make_surface_grid(square, 0, 1e-4), core::InputError);
}

surface::Surface precise_surface()
{
    surface::Surface surface;
    surface.shape = some_bspline();
    Eigen::MatrixXd weights = Eigen::MatrixXd::Constant(6, 5, 30);
    weights.block(2, 1, 2, 3).setZero(); // a hole
    surface.precision = surface::SplinePrecision{weights, 1e-3};
    return surface;
}

// Reference: the inverse of the precision by Eigen.
TEST(Precision, GivesSigmaAndCovariance)
{
    const surface::Surface surface = precise_surface();
    const surface::BandMatrix band =
        surface::precision_matrix(std::get<surface::Bspline>(surface.shape), *surface.precision);
    Eigen::MatrixXd H(band.size(), band.size());
    H.setZero();
    for (Eigen::Index i = 0; i < band.size(); ++i)
        for (Eigen::Index j = std::max<Eigen::Index>(0, i - band.half_bandwidth()); j <= i; ++j)
            H(i, j) = H(j, i) = band(i, j);
    const Eigen::Matrix2d turn = Eigen::Rotation2Dd(0.4).toRotationMatrix();
    Eigen::Matrix2Xd xy = turn * (66 * Eigen::Matrix2Xd::Random(2, 30).cwiseAbs());
    xy.row(1) *= 0.6;
    xy.colwise() += Eigen::Vector2d(-30, -20);
    Eigen::Index inside = 0;
    for (Eigen::Index i = 0; i < xy.cols(); ++i)
        if (std::isfinite(surface::height(surface, xy.col(i)))) xy.col(inside++) = xy.col(i).eval();
    ASSERT_GT(inside, 10);
    xy.conservativeResize(2, inside);
    const Eigen::MatrixXd G = surface::height_gradients(surface.shape, xy);
    const Eigen::MatrixXd expected = G.transpose() * H.inverse() * G;
    EXPECT_LT((surface::height_covariance(std::get<surface::Bspline>(surface.shape), *surface.precision, xy) - expected)
                  .cwiseAbs()
                  .maxCoeff(),
              1e-9 * expected.maxCoeff());
    EXPECT_LT((surface::sigmas(surface, xy).cwiseAbs2() - expected.diagonal()).cwiseAbs().maxCoeff(),
              1e-9 * expected.maxCoeff());
    EXPECT_NEAR(surface::sigma(surface, xy.col(3)), std::sqrt(expected(3, 3)), 1e-9);
    EXPECT_TRUE(std::isnan(surface::sigma(surface, {1000, 0})));
    EXPECT_TRUE(surface::has_sigma(surface));
}

TEST(Precision, IsWrittenAndRead)
{
    surface::Surface surface = precise_surface();
    surface.precision->weights(0, 0) = 1234.5678;
    for (const units::Units::Length unit : {units::Units::Length::mm, units::Units::Length::in}) {
        surface.units.length = unit;
        const surface::Surface back =
            surface::parse_surface(json::Reader::parse(surface::to_json(surface).text(), "test"));
        ASSERT_TRUE(back.precision);
        EXPECT_NEAR(back.precision->amplitude, 1e-3, 1e-12);
        // four digits
        EXPECT_LT(((back.precision->weights - surface.precision->weights).array().abs() -
                   6e-4 * surface.precision->weights.array())
                      .maxCoeff(),
                  1e-12);
    }
    const std::string text = surface::to_json(surface).text();
    const auto refused = [&](const std::string& from, const std::string& to) {
        std::string changed = text;
        changed.replace(changed.find(from), from.size(), to);
        EXPECT_THROW(surface::parse_surface(json::Reader::parse(changed, "test")), core::InputError) << to;
    };
    refused("\"amplitude\"", "\"amplitud\"");
    refused("\"weights\": [\n", "\"weights\": [[1],\n");
    surface.precision->weights.conservativeResize(Eigen::NoChange, surface.precision->weights.cols() - 1);
    EXPECT_THROW(surface::parse_surface(json::Reader::parse(surface::to_json(surface).text(), "test")),
                 core::InputError);
}

} // namespace surface_test
} // namespace fettle
