#include "belt/fem_element.h"

#include <Eigen/LU>

#include <cmath>

namespace fettle::belt {

namespace {

using Eigen::Vector3d;

/// Gradients of the eight shape functions in natural coordinates, at a point of [-1, 1]³.
Hexahedron shape_gradients(const Vector3d& xi)
{
    Hexahedron gradients;
    for (int corner = 0; corner < 8; ++corner) {
        Vector3d side;
        for (int axis = 0; axis < 3; ++axis) side[axis] = (corner >> axis) % 2 == 0 ? -1 : 1;
        const Vector3d factor = (Vector3d::Ones() + side.cwiseProduct(xi)) / 2;
        gradients.col(corner) << side.x() / 2 * factor.y() * factor.z(), side.y() / 2 * factor.z() * factor.x(),
            side.z() / 2 * factor.x() * factor.y();
    }
    return gradients;
}

} // namespace

HexahedronStiffness stiffness(const Hexahedron& corners, const ElasticLayer& material)
{
    const double shear = material.young / (2 * (1 + material.poisson));    // μ
    const double bulk = material.young / (3 * (1 - 2 * material.poisson)); // κ = λ + 2μ/3
    HexahedronStiffness result = HexahedronStiffness::Zero();
    Eigen::Matrix<double, 24, 1> dilatation = Eigen::Matrix<double, 24, 1>::Zero(); // ∫ div u dV, per degree of freedom
    double volume = 0;
    for (int point = 0; point < 8; ++point) { // 2 x 2 x 2 Gauss points
        Vector3d xi;
        for (int axis = 0; axis < 3; ++axis) xi[axis] = ((point >> axis) % 2 == 0 ? -1 : 1) / std::sqrt(3);
        const Hexahedron local_gradients = shape_gradients(xi);
        const Eigen::Matrix3d jacobian = local_gradients * corners.transpose();
        const double weight = jacobian.determinant();
        const Hexahedron gradients = jacobian.inverse() * local_gradients;
        volume += weight;
        dilatation += weight * gradients.reshaped();
        // The deviatoric part, 2μ (ε:ε - div²/3); the volumetric part, κ div², uses the mean dilatation.
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

} // namespace fettle::belt
