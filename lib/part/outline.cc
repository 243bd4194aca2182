#include "part/outline.h"

#include "core/constants.h"

#include <Eigen/Geometry>

#include <cmath>
#include <numbers>

namespace fettle::part {
namespace {

using Eigen::Matrix2Xd;
using Eigen::Vector2d;

// With this number the chord error on a radius of 50 mm is 50 (1 - cos(π/360)) = 0.002 mm.
constexpr int kCornersPerCircle = 360;

/// Points on an arc, both ends included.
Matrix2Xd arc(const Vector2d& centre, double radius, double from, double sweep)
{
    const int count = 2 + static_cast<int>(kCornersPerCircle * std::abs(sweep) / (2 * std::numbers::pi));
    const Eigen::ArrayXd angle = Eigen::ArrayXd::LinSpaced(count, from, from + sweep);
    Matrix2Xd points(2, count);
    points.row(0) = centre.x() + radius * angle.cos().transpose();
    points.row(1) = centre.y() + radius * angle.sin().transpose();
    return points;
}

Matrix2Xd transform(const Matrix2Xd& points, const Vector2d& centre, double angle)
{
    return (Eigen::Rotation2Dd(angle).toRotationMatrix() * points).colwise() + centre;
}

Matrix2Xd ellipse(json::Reader reader, double mm)
{
    const Vector2d centre = mm * reader.vector("centre", 2);
    const Vector2d axes = mm * reader.vector("semi_axes", 2);
    const double angle = reader.number_or("angle_deg", 0) * core::kRadPerDegree;
    if (!(axes.minCoeff() > 0)) reader.refuse("semi_axes", "must be positive");
    reader.reject_unknown_keys();
    const Matrix2Xd circle = arc(Vector2d::Zero(), 1, 0, 2 * std::numbers::pi);
    return transform(axes.asDiagonal() * circle.leftCols(circle.cols() - 1), centre, angle);
}

Matrix2Xd letter_h(json::Reader reader, double mm)
{
    const Vector2d centre = mm * reader.vector("centre", 2);
    const Vector2d half = mm * reader.vector("size", 2) / 2;
    const double stroke = mm * reader.number("stroke", core::Range::positive());
    const double angle = reader.number_or("angle_deg", 0) * core::kRadPerDegree;
    const double leg = half.x() - stroke; // inner edge of a leg
    const double bar = stroke / 2;
    if (!(leg > 0 && half.y() > bar)) reader.refuse("stroke", "is too thick for the letter's size");
    reader.reject_unknown_keys();
    Matrix2Xd corners(2, 12);
    corners << -half.x(), -leg, -leg, leg, leg, half.x(), half.x(), leg, leg, -leg, -leg, -half.x(), //
        -half.y(), -half.y(), -bar, -bar, -half.y(), -half.y(), half.y(), half.y(), bar, bar, half.y(), half.y();
    return transform(corners, centre, angle);
}

/// A disc with a round bite out of its edge.
Matrix2Xd moon(json::Reader reader, double mm)
{
    const Vector2d centre = mm * reader.vector("centre", 2);
    const double radius = mm * reader.number("radius", core::Range::positive());
    json::Reader bite = reader.object("bite");
    const Vector2d bite_centre = mm * bite.vector("centre", 2);
    const double bite_radius = mm * bite.number("radius", core::Range::positive());
    const double distance = (bite_centre - centre).norm();
    if (!(distance > std::abs(radius - bite_radius) && distance < radius + bite_radius))
        bite.refuse("", "its circle does not cross the moon's");
    bite.reject_unknown_keys();
    reader.reject_unknown_keys();
    // Law of cosines: the circles cross at ± these angles from the line between the centres.
    const auto half_angle = [&](double r, double other) {
        return std::acos((distance * distance + r * r - other * other) / (2 * distance * r));
    };
    const Vector2d towards = bite_centre - centre;
    const double heading = std::atan2(towards.y(), towards.x());
    const double outer = half_angle(radius, bite_radius);
    const double inner = half_angle(bite_radius, radius);
    const Matrix2Xd back = arc(centre, radius, heading + outer, 2 * std::numbers::pi - 2 * outer);
    const Matrix2Xd hollow = arc(bite_centre, bite_radius, heading + std::numbers::pi + inner, -2 * inner);
    Matrix2Xd corners(2, back.cols() + hollow.cols() - 2); // both arcs contain the tips
    corners << back, hollow.middleCols(1, hollow.cols() - 2);
    return corners;
}

double twice_area(const Matrix2Xd& polygon)
{
    double sum = 0;
    for (Eigen::Index i = 0, n = polygon.cols(); i < n; ++i) {
        const Vector2d a = polygon.col(i), b = polygon.col((i + 1) % n);
        sum += a.x() * b.y() - a.y() * b.x();
    }
    return sum;
}

Matrix2Xd polygon(json::Reader& reader, double mm)
{
    const Matrix2Xd corners = mm * reader.matrix("polygon", 2).transpose();
    if (corners.cols() < 3) reader.refuse("polygon", "needs 3 points or more, got " + std::to_string(corners.cols()));
    const double area = twice_area(corners);
    if (area == 0) reader.refuse("polygon", "has no area");
    return area > 0 ? corners : Matrix2Xd(corners.rowwise().reverse());
}

} // namespace

Matrix2Xd read_outline(json::Reader reader, double mm)
{
    Matrix2Xd corners;
    if (reader.has("ellipse"))
        corners = ellipse(reader.object("ellipse"), mm);
    else if (reader.has("letter_h"))
        corners = letter_h(reader.object("letter_h"), mm);
    else if (reader.has("moon"))
        corners = moon(reader.object("moon"), mm);
    else if (reader.has("polygon"))
        corners = polygon(reader, mm);
    else
        reader.refuse("", "needs one of polygon, ellipse, letter_h, moon");
    reader.reject_unknown_keys();
    return corners;
}

} // namespace fettle::part
