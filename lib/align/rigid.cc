#include "align/rigid.h"

#include "core/content.h"
#include "core/decompositions.h"
#include "core/error.h"
#include "core/file.h"
#include "core/lines.h"
#include "core/text.h"

#include <Eigen/Dense>

#include <cmath>
#include <cstdio>
#include <ostream>

namespace fettle::align {

namespace {

// Largest element of RᵀR - I. A matrix typed with seven digits still counts as a rotation, one with scale or shear does
// not.
constexpr double kMaxOrthogonalityError = 1e-5;

Eigen::RowVector4d parse_row(const core::Lines& lines, const std::string& source)
{
    Eigen::RowVector4d row;
    const std::vector<std::string_view> numbers = core::words(lines.line());
    if (numbers.size() != 4)
        throw core::InputError(source,
                               lines.location() + ": expected 4 numbers, got " + std::to_string(numbers.size()));
    for (int k = 0; k < 4; ++k) {
        const std::optional<double> number = core::parse_number(numbers[k]);
        if (!number || !std::isfinite(*number))
            throw core::InputError(source,
                                   lines.location() + ": expected a number, got " + core::in_quotes(numbers[k]));
        row[k] = *number;
    }
    return row;
}

} // namespace

Eigen::Matrix4d read_transform(const std::string& path)
{
    const std::string bytes = core::read_file(path), source = core::display_name(path);
    core::refuse_other_content(bytes, source, "a transform");
    Eigen::Matrix4d matrix;
    Eigen::Index rows = 0;
    for (core::Lines lines(core::strip_byte_order_mark(bytes, source)); lines.next();) {
        if (core::words(lines.line()).empty()) continue;
        if (rows == 4) throw core::InputError(source, lines.location() + ": a transform has only 4 lines");
        matrix.row(rows++) = parse_row(lines, source);
    }
    if (rows < 4) throw core::InputError(source, "expected 4 lines of 4 numbers, got " + std::to_string(rows));
    if (matrix.row(3) != Eigen::RowVector4d(0, 0, 0, 1))
        throw core::InputError(source, "the last line must be 0 0 0 1");
    const Eigen::Matrix3d R = matrix.topLeftCorner<3, 3>();
    const double error = (R.transpose() * R - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
    if (!(error <= kMaxOrthogonalityError))
        throw core::InputError(source,
                               "is not a rotation: RᵀR differs from the identity by " + core::to_short_text(error));
    if (R.determinant() < 0) throw core::InputError(source, "is a reflection: the determinant is -1");
    return matrix;
}

void write_transform(std::ostream& out, const Eigen::Matrix4d& matrix)
{
    for (Eigen::Index i = 0; i < 4; ++i)
        for (Eigen::Index j = 0; j < 4; ++j) {
            std::array<char, 32> text; // sign, 17 digits, point, exponent
            std::snprintf(text.data(), text.size(), "%.17g", matrix(i, j));
            out << text.data() << (j < 3 ? ' ' : '\n');
        }
}

Twist TwistFrame::gradient(const Eigen::Vector3d& point, const Eigen::Vector3d& direction) const
{
    Twist g;
    g << direction, (point - centre).cross(direction) / radius;
    return g;
}

Eigen::Isometry3d TwistFrame::motion(const Twist& x) const
{
    const Eigen::Vector3d rotation = x.tail<3>() / radius;
    Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
    if (rotation.norm() > 0)
        motion.linear() = Eigen::AngleAxisd(rotation.norm(), rotation.normalized()).toRotationMatrix();
    motion.translation() = centre - motion.linear() * centre + x.head<3>();
    return motion;
}

TwistFrame twist_frame(const Eigen::Matrix3Xd& points)
{
    const Eigen::Vector3d centre = points.rowwise().mean();
    return {centre, std::sqrt((points.colwise() - centre).colwise().squaredNorm().mean())};
}

TwistMatrix without_held_axes(TwistMatrix A, const HeldAxes& held)
{
    for (int k = 0; k < 6; ++k)
        if (held[k]) {
            A.row(k).setZero();
            A.col(k).setZero();
        }
    return A;
}

Twist solve_step(const TwistMatrix& A, const Twist& b, const HeldAxes& held, double min_eigenvalue)
{
    Twist free_b = b;
    for (int k = 0; k < 6; ++k)
        if (held[k]) free_b[k] = 0;
    const auto [values, vectors] = core::symmetric_eigen(without_held_axes(A, held));
    Twist x = Twist::Zero();
    for (int k = 0; k < 6; ++k)
        if (values[k] > min_eigenvalue) x -= vectors.col(k) * (vectors.col(k).dot(free_b) / values[k]);
    for (int k = 0; k < 6; ++k)
        if (held[k]) x[k] = 0; // removes the rounding of the eigenvectors
    return x;
}

Eigen::Isometry3d orthonormalized(Eigen::Isometry3d motion)
{
    motion.linear() = Eigen::Quaterniond(motion.linear()).normalized().toRotationMatrix();
    return motion;
}

} // namespace fettle::align
