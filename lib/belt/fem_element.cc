#include "belt/fem_element.h"

#include <Eigen/LU>

#include <cmath>

namespace fettle {

namespace {

using Eigen::Vector3d;

/// Slopes of the eight shape functions along the element's axes, at a place in -1 … 1.
Hexahedron shape_slopes(const Vector3d& at)
{
    Hexahedron slopes;
    for (int corner = 0; corner < 8; ++corner) {
        Vector3d side;
        for (int axis = 0; axis < 3; ++axis) side[axis] = (corner >> axis) % 2 == 0 ? -1 : 1;
        const Vector3d factor = (Vector3d::Ones() + side.cwiseProduct(at)) / 2;
        slopes.col(corner) << side.x() / 2 * factor.y() * factor.z(), side.y() / 2 * factor.z() * factor.x(),
            side.z() / 2 * factor.x() * factor.y();
    }
    return slopes;
}

} // namespace

HexahedronStiffness stiffness(const Hexahedron& corners, const ElasticLayer& material)
{
    const double shear = material.young / (2 * (1 + material.poisson));    // μ
    const double bulk = material.young / (3 * (1 - 2 * material.poisson)); // κ = λ + 2μ/3
    HexahedronStiffness result = HexahedronStiffness::Zero();
    Eigen::Matrix<double, 24, 1> dilatation = Eigen::Matrix<double, 24, 1>::Zero(); // ∫ div, by displacement
    double volume = 0;
    for (int point = 0; point < 8; ++point) { // Gauss, two along each axis
        Vector3d at;
        for (int axis = 0; axis < 3; ++axis) at[axis] = ((point >> axis) % 2 == 0 ? -1 : 1) / std::sqrt(3);
        const Hexahedron slopes = shape_slopes(at);
        const Eigen::Matrix3d jacobian = slopes * corners.transpose();
        const double weight = jacobian.determinant();
        const Hexahedron gradients = jacobian.inverse() * slopes;
        volume += weight;
        dilatation += weight * gradients.reshaped();
        // 2μ (ε:ε - div²/3); the rest, κ div², by the mean.
        for (int b = 0; b < 8; ++b)
            for (int a = 0; a < 8; ++a) {
                const Vector3d ga = gradients.col(a), gb = gradients.col(b);
                result.block<3, 3>(3 * a, 3 * b) +=
                    weight * shear *
                    (ga.dot(gb) * Eigen::Matrix3d::Identity() + gb * ga.transpose() - 2.0 / 3 * ga * gb.transpose());
            }
    }
    return result + bulk / volume * dilatation * dilatation.transpose();
}

} // namespace fettle
