#include "align/rigid.h"

#include "core/decompositions.h"
#include "core/error.h"
#include "core/file.h"
#include "core/lines.h"
#include "core/text.h"

#include <Eigen/Dense>

#include <cmath>
#include <cstdio>
#include <ostream>

namespace fettle {

namespace {

// A matrix typed with seven digits is still a rotation; one with a scale or a shear of more is refused.
constexpr double kBent = 1e-5;

Eigen::RowVector4d row_of(const Lines& lines, const std::string& source)
{
    Eigen::RowVector4d row;
    const std::vector<std::string_view> numbers = words(lines.line());
    if (numbers.size() != 4)
        throw InputError(source, lines.place() + ": expected 4 numbers, got " + std::to_string(numbers.size()));
    for (std::size_t k = 0; k < 4; ++k) {
        const std::optional<double> number = parse_number(numbers[k]);
        if (!number || !std::isfinite(*number))
            throw InputError(source, lines.place() + ": expected a number, got " + in_quotes(numbers[k]));
        row[static_cast<Eigen::Index>(k)] = *number;
    }
    return row;
}

} // namespace

Eigen::Matrix4d read_transform(const std::string& path)
{
    const std::string bytes = read_whole(path), source = display_name(path);
    Eigen::Matrix4d matrix;
    Eigen::Index rows = 0;
    for (Lines lines(without_mark(bytes, source)); lines.next();) {
        if (words(lines.line()).empty()) continue;
        if (rows == 4) throw InputError(source, lines.place() + ": a transform has 4 lines, this is one more");
        matrix.row(rows++) = row_of(lines, source);
    }
    if (rows < 4) throw InputError(source, "expected 4 lines of 4 numbers, got " + std::to_string(rows));
    if (matrix.row(3) != Eigen::RowVector4d(0, 0, 0, 1)) throw InputError(source, "the last line must be 0 0 0 1");
    const Eigen::Matrix3d R = matrix.topLeftCorner<3, 3>();
    const double bent = (R.transpose() * R - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
    if (!(bent <= kBent))
        throw InputError(source, "is no rotation: RᵀR differs from the identity by " + to_short_text(bent));
    if (R.determinant() < 0) throw InputError(source, "mirrors: the rotation's determinant is -1");
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

Cloud moved(Cloud cloud, const Eigen::Matrix4d& matrix, double mm)
{
    const auto apply = [&](const Eigen::Vector3d& p) {
        Eigen::Vector3d to;
        for (Eigen::Index k = 0; k < 3; ++k)
            to[k] = ((matrix(k, 0) * p[0] + matrix(k, 1) * p[1]) + matrix(k, 2) * p[2]) + matrix(k, 3);
        return to;
    };
    for (Eigen::Index i = 0; i < cloud.size(); ++i) cloud.xyz.col(i) = mm * apply(cloud.xyz.col(i) / mm);
    const Eigen::Matrix3d R = matrix.topLeftCorner<3, 3>();
    if (has_normals(cloud)) set_normals(cloud, R * normals(cloud));
    cloud.view_origin = mm * apply(cloud.view_origin / mm);
    const Eigen::Quaterniond turned = (Eigen::Quaterniond(R) * cloud.view_orientation).normalized();
    cloud.view_orientation = turned.w() < 0 ? Eigen::Quaterniond(-turned.coeffs()) : turned; // one of two signs
    return cloud;
}

Twist TwistFrame::gradient(const Eigen::Vector3d& point, const Eigen::Vector3d& direction) const
{
    Twist g;
    g << direction, (point - centre).cross(direction) / radius;
    return g;
}

Eigen::Isometry3d TwistFrame::motion(const Twist& x) const
{
    const Eigen::Vector3d turn = x.tail<3>() / radius;
    Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
    if (turn.norm() > 0) motion.linear() = Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix();
    motion.translation() = centre - motion.linear() * centre + x.head<3>();
    return motion;
}

TwistFrame twist_frame(const Eigen::Matrix3Xd& points)
{
    const Eigen::Vector3d centre = points.rowwise().mean();
    return {centre, std::sqrt((points.colwise() - centre).colwise().squaredNorm().mean())};
}

Twist solve_step(const TwistMatrix& A, const Twist& b, const HeldAxes& held, double least)
{
    TwistMatrix free_A = A;
    Twist free_b = b;
    for (Eigen::Index k = 0; k < 6; ++k)
        if (held[static_cast<std::size_t>(k)]) {
            free_A.row(k).setZero();
            free_A.col(k).setZero();
            free_b[k] = 0;
        }
    const SymmetricEigen<6> modes = symmetric_eigen(free_A);
    Twist x = Twist::Zero();
    for (Eigen::Index k = 0; k < 6; ++k)
        if (modes.values[k] > least) x -= modes.vectors.col(k) * (modes.vectors.col(k).dot(free_b) / modes.values[k]);
    for (Eigen::Index k = 0; k < 6; ++k)
        if (held[static_cast<std::size_t>(k)]) x[k] = 0; // exactly
    return x;
}

Eigen::Isometry3d straightened(const Eigen::Isometry3d& motion)
{
    Eigen::Isometry3d straight = motion;
    straight.linear() = Eigen::Quaterniond(motion.linear()).normalized().toRotationMatrix();
    return straight;
}

} // namespace fettle
