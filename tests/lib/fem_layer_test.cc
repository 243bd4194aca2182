// Finite elements of the layer on its hub: the element (patch test, one constraint), the wheel's ring wave by wave
// against the ring assembled as a whole, and the layer against exact solutions.

#include "belt/fem_element.h"
#include "belt/fem_layer.h"
#include "core/error.h"
#include "layer_theory.h"

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

using namespace fettle;

namespace fem_layer_test {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using std::numbers::pi;

/// The corners of one of 2 x 2 x 2 crooked elements of 4 mm; corners of the same place are at the same place.
belt::Hexahedron crooked(const Eigen::Vector3i& element)
{
    belt::Hexahedron corners;
    for (int k = 0; k < 8; ++k) {
        const Vector3d at = 4 * (element + Eigen::Vector3i(k & 1, k >> 1 & 1, k >> 2)).cast<double>();
        corners.col(k) = at + Vector3d(std::sin(at.y() + 2 * at.z()), 0.8 * std::cos(at.x() - at.z()),
                                       0.9 * std::sin(at.x() + 3 * at.y()));
    }
    return corners;
}

const Eigen::Matrix3d kGradient{{0.3, -0.2, 0.5}, {0.7, 0.1, -0.4}, {-0.6, 0.8, 0.2}};

// Patch test (Irons): an even strain is an answer of crooked elements, without force on the corner within, at the exact
// energy V (μ ε:ε + λ/2 div²).
TEST(FemElement, PassesThePatchTest)
{
    const Eigen::Matrix3d strain = (kGradient + kGradient.transpose()) / 2;
    for (const double poisson : {0.0, 0.3, 0.499}) {
        const belt::ElasticLayer rubber{1, 5, poisson};
        const double shear = 5 / (2 * (1 + poisson)), lambda = 2 * shear * poisson / (1 - 2 * poisson);
        const double density = shear * strain.squaredNorm() + lambda / 2 * std::pow(strain.trace(), 2);
        Vector3d inner = Vector3d::Zero();
        double greatest = 0;
        for (int e = 0; e < 8; ++e) {
            const belt::Hexahedron corners = crooked({e & 1, e >> 1 & 1, e >> 2});
            const belt::HexahedronStiffness K = belt::stiffness(corners, rubber);
            const belt::Hexahedron moved = kGradient * corners;
            const Eigen::Matrix<double, 24, 1> force = K * moved.reshaped();
            inner += force.segment<3>(3 * (7 - e)); // the corner that all have
            greatest = std::max(greatest, force.cwiseAbs().maxCoeff());
            // At ν = 0 a swelling x costs the volume three times μ.
            const belt::HexahedronStiffness plain = belt::stiffness(corners, {1, 2, 0});
            const double volume = corners.reshaped().dot(plain * corners.reshaped()) / 6;
            EXPECT_NEAR(moved.reshaped().dot(force) / 2, volume * density, 1e-11 * volume * density);
            const belt::Hexahedron turned = Eigen::Matrix3d{{0, -1, 2}, {1, 0, 3}, {-2, -3, 0}} * corners;
            EXPECT_LE((K * turned.reshaped()).cwiseAbs().maxCoeff(), 1e-12 * K.cwiseAbs().maxCoeff() * turned.norm());
        }
        EXPECT_LE(inner.cwiseAbs().maxCoeff(), 1e-12 * greatest);
    }
}

// With the shear modulus kept, the ratio of Poisson adds a matrix of rank one: one constraint an element at ν = 1/2,
// where elements with one at each of eight points lock.
TEST(FemElement, HasOneConstraint)
{
    const belt::Hexahedron corners = crooked({0, 1, 1});
    const auto of = [&](double poisson) { return belt::stiffness(corners, {1, 2 * (1 + poisson), poisson}); };
    const belt::HexahedronStiffness more = of(0.4999) - of(0.2);
    Index k = 0;
    const double max = more.diagonal().maxCoeff(&k);
    EXPECT_GT(max, 100);
    EXPECT_LE((more - more.col(k) * more.row(k) / more(k, k)).cwiseAbs().maxCoeff(), 1e-11 * max);
}

/// A wheel with few elements: twelve around it, three levels, uneven columns.
belt::LayerMesh small_ring(double poisson, int around)
{
    belt::LayerMesh mesh;
    mesh.layer = {6, 5, poisson};
    mesh.radius = 20;
    mesh.cell_size = {2 * pi * mesh.radius / around, 2};
    mesh.node_depths = VectorXd::Zero(4);
    mesh.node_depths << 0, 1, 3, 6;
    mesh.node_positions = VectorXd::Zero(5);
    mesh.node_positions << -5, -2, 0, 2, 3.5;
    mesh.first_loaded = 1;
    mesh.loaded_count = 3;
    return mesh;
}

// All elements of a whole wheel assembled in three dimensions, in one frame, against the sum of its waves.
TEST(FemLayer, WavesSumUpToTheWholeWheel)
{
    constexpr int kAround = 12;
    for (const double poisson : {0.0, 0.45, 0.499}) {
        const belt::LayerMesh mesh = small_ring(poisson, kAround);
        const Index levels = 3, columns = mesh.node_positions.size(), size = 3 * kAround * columns * levels;
        const auto unknown = [&](int ring, Index column, Index level) {
            return 3 * ((ring % kAround * columns + column) * levels + level);
        };
        const auto out = [&](int ring) {
            const double angle = 2 * pi * ring / kAround;
            return Vector3d(std::sin(angle), 0, -std::cos(angle));
        };
        MatrixXd A = MatrixXd::Zero(size, size);
        for (int ring = 0; ring < kAround; ++ring)
            for (Index column = 0; column + 1 < columns; ++column)
                for (Index level = 0; level < levels; ++level) {
                    belt::Hexahedron corners;
                    for (int k = 0; k < 8; ++k)
                        corners.col(k) = (mesh.radius - mesh.node_depths[level + (k >> 2)]) * out(ring + (k & 1)) +
                                         mesh.node_positions[column + (k >> 1 & 1)] * Vector3d::UnitY();
                    const belt::HexahedronStiffness K = belt::stiffness(corners, mesh.layer);
                    for (int a = 0; a < 8; ++a)
                        for (int b = 0; b < 8; ++b)
                            if (level + (a >> 2) < levels && level + (b >> 2) < levels)
                                A.block<3, 3>(unknown(ring + (a & 1), column + (a >> 1 & 1), level + (a >> 2)),
                                              unknown(ring + (b & 1), column + (b >> 1 & 1), level + (b >> 2))) +=
                                    K.block<3, 3>(3 * a, 3 * b);
                }
        VectorXd force = VectorXd::Zero(size);
        force.segment<3>(unknown(0, 2, 0)) = -out(0);
        const VectorXd moved = A.llt().solve(force);
        for (int ring = 0; ring < kAround; ++ring)
            for (Index j = 0; j < mesh.loaded_count; ++j) {
                double sum = 0;
                for (int k = 0; k < kAround; ++k) {
                    const double phase = 2 * pi * k / kAround;
                    sum += belt::wave_compliance(mesh, phase)(j, 1) * std::cos(phase * ring) / kAround;
                }
                const double in = -moved.segment<3>(unknown(ring, mesh.first_loaded + j, 0)).dot(out(ring));
                EXPECT_NEAR(in, sum, 1e-10 * moved.norm());
            }
    }
}

// The window's displacement is what a wheel so large that nothing comes around it gives, for any thickness.
TEST(FemLayer, IsATapeWithoutEnd)
{
    for (const double thickness : {0.5, 6.0}) {
        constexpr int kAround = 600;
        constexpr Index kRows = 24;
        belt::LayerMesh mesh = small_ring(0.49, kAround);
        mesh.radius = 100;
        mesh.cell_size.x() = 2 * pi * mesh.radius / kAround;
        mesh.layer.thickness = thickness;
        mesh.node_depths *= thickness / 6;
        MatrixXd pressure = MatrixXd::Zero(kRows, mesh.loaded_count);
        pressure(3, 1) = 1;
        const MatrixXd found = belt::FemLayer(mesh, kRows).displacement(pressure);
        MatrixXd expected = MatrixXd::Zero(kRows, mesh.loaded_count);
        for (int k = 0; k < kAround; ++k) {
            const double phase = 2 * pi * k / kAround;
            const VectorXd wave = belt::wave_compliance(mesh, phase).col(1) * mesh.cell_size.prod() / kAround;
            for (Index i = 0; i < kRows; ++i)
                expected.row(i) += std::cos(static_cast<double>(i - 3) * phase) * wave.transpose();
        }
        EXPECT_LE((found - expected).cwiseAbs().maxCoeff(), 1e-6 * expected.maxCoeff());
    }
}

// What a free side does falls by exp(-0.74) a thickness along the layer, or faster: s = cos s is where the denominator
// of the flat layer's compliance is 0 at ν = 1/2, s = qh / i.
constexpr double kWide = 40;

/// In by how much for even pressure of 1 MPa, at the middle of a wheel's width, elements as long as they are deep.
double even_give(const belt::ElasticLayer& layer, double radius, double width, Index elements)
{
    const double side = layer.thickness / static_cast<double>(elements);
    const auto columns = static_cast<Index>(std::lround(width / side));
    belt::LayerMesh mesh{layer,
                         radius,
                         {side, side},
                         VectorXd::LinSpaced(elements + 1, 0, layer.thickness),
                         VectorXd::LinSpaced(columns + 1, -width / 2, width / 2),
                         0,
                         columns + 1};
    VectorXd force = VectorXd::Constant(columns + 1, side * side);
    force[0] = force[columns] = side * side / 2;
    return (belt::wave_compliance(mesh, 0) * force)[columns / 2];
}

// A round layer under even pressure p, u = B (R/Rh² - 1/R) with B = p/2 / ((λ + μ)/Rh² + μ/R²), Rh the hub's radius
// (Lamé): of second order, and that of the flat layer where the wheel is large.
TEST(FemLayer, IsLamesUnderEvenPressure)
{
    const double R = 20, h = 6, Rh = R - h;
    for (const double poisson : {0.0, 0.3, 0.45}) {
        const belt::ElasticLayer layer{h, 5, poisson};
        const double shear = 5 / (2 * (1 + poisson)), lambda = 2 * shear * poisson / (1 - 2 * poisson);
        const double exact = (R / (Rh * Rh) - 1 / R) / 2 / ((lambda + shear) / (Rh * Rh) + shear / (R * R));
        const double coarse = even_give(layer, R, kWide * h, 4) - exact,
                     fine = even_give(layer, R, kWide * h, 8) - exact;
        EXPECT_LE(std::abs(fine), 0.01 * exact);
        EXPECT_NEAR(coarse / fine, 4, 0.4);
        EXPECT_NEAR(even_give(layer, 1e6, kWide * h, 4), uniform_compliance(layer), 1e-3 * uniform_compliance(layer));
    }
}

// Without a change of width a layer with free sides deforms like a bar, however narrow it is: p h / E.
TEST(FemLayer, HasFreeSides)
{
    const belt::ElasticLayer bar{6, 5, 0};
    for (const double width : {1.5, 6.0, 60.0}) EXPECT_NEAR(even_give(bar, 1e7, width, 4), 6.0 / 5, 1e-5);
    // Rubber goes out at the sides: of a pad as wide as thick, gliding below, more than two thirds of a free bar's.
    const belt::ElasticLayer rubber{6, 5, 0.49};
    EXPECT_GT(even_give(rubber, 1e7, 6, 8), 0.6 * (1 - 0.49 * 0.49) * 6 / 5);
    EXPECT_LT(even_give(rubber, 1e7, 6 * kWide, 4), 1.001 * uniform_compliance(rubber));
}

/// In at the middle of a square of four thirds of a thickness under even pressure, so many thicknesses from the edge to
/// the nearer side of it, over what it is without edges.
double softer(double poisson, double thicknesses)
{
    constexpr double kThickness = 3, kCell = 0.5;
    constexpr Index kCells = 64, kSquare = 8;
    const belt::ElasticLayer layer{kThickness, 5, poisson};
    const belt::LayerMesh mesh = belt::layer_mesh(layer, 1e7, kCells * kCell, {kCell, kCell}, kCells, 8);
    const belt::FemLayer fem(mesh, kCells);
    const auto at = [&](Index from) {
        MatrixXd pressure = MatrixXd::Zero(kCells, kCells);
        pressure.block(28, from, kSquare, kSquare).setOnes();
        return fem.displacement(pressure).block(28, from, kSquare, kSquare).mean();
    };
    return at(std::lround(thicknesses * kThickness / kCell)) / at((kCells - kSquare) / 2) - 1;
}

// Softer near the free edge, the more the less rubber can change its volume; barely from 1.5 thicknesses on, which is
// where a contact is called near the edge.
TEST(FemLayer, IsSofterNearTheEdge)
{
    double before = 1;
    for (const double thicknesses : {0.0, 0.5, 1.0, 1.5}) {
        const double now = softer(0.49, thicknesses);
        EXPECT_LT(now, before / 2);
        before = now;
    }
    EXPECT_LE(before, 0.01);
    EXPECT_GE(softer(0.49, 0), 0.35);
    EXPECT_NEAR(softer(0.45, 0), 0.32, 0.03);
    EXPECT_NEAR(softer(0.3, 0), 0.17, 0.03);
}

TEST(FemLayer, RefusesWhatItCannotMesh)
{
    EXPECT_THROW(belt::layer_mesh({10, 5, 0.4}, 10, 50, {1, 1}, 32, 8), core::InputError);
    EXPECT_THROW(belt::layer_mesh({10, 5, 0.4}, 100, 30, {1, 1}, 32, 8), core::InputError);
}

} // namespace fem_layer_test
