#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>

namespace fettle::geometry {

/// A triangle clipped to an upright prism over a rectangle in x and y: a convex polygon, each of whose four sides adds
/// a corner at most.
template <int Dimension>
class ClippedTriangle {
  public:
    using Corner = Eigen::Matrix<double, Dimension, 1>;

    /// Clips by one side of the rectangle after the other (Sutherland & Hodgman, Reentrant polygon clipping, 1974).
    /// @param triangle   one corner per column
    /// @param tolerance  by which the rectangle is enlarged on all sides
    ClippedTriangle(const Eigen::Matrix<double, Dimension, 3>& triangle, const Eigen::AlignedBox2d& rectangle,
                    double tolerance = 0)
    {
        for (int k = 0; k < 3; ++k) corners_[k] = triangle.col(k);
        for (int side = 0; side < 4; ++side)
            clip([&, axis = side / 2](const Corner& p) {
                return (side % 2 == 0 ? p[axis] - rectangle.min()[axis] : rectangle.max()[axis] - p[axis]) + tolerance;
            });
    }

    /// In the order of the triangle's; none if the triangle is outside.
    std::span<const Corner> corners() const& { return {corners_.data(), count_}; }
    std::span<const Corner> corners() const&& = delete;

  private:
    /// @param inside  distance from the side, positive inside
    template <typename Distance>
    void clip(const Distance& inside)
    {
        std::array<Corner, 7> kept;
        std::size_t count = 0;
        for (std::size_t i = 0; i < count_; ++i) {
            const Corner &p = corners_[i], &q = corners_[(i + 1) % count_];
            const double at_p = inside(p), at_q = inside(q);
            if (at_p >= 0) kept[count++] = p;
            if ((at_p < 0) != (at_q < 0)) kept[count++] = p + at_p / (at_p - at_q) * (q - p);
        }
        std::copy_n(kept.begin(), count, corners_.begin());
        count_ = count;
    }

    std::array<Corner, 7> corners_;
    std::size_t count_ = 3;
};

/// Area of a plane polygon, mm² for mm.
inline double polygon_area(std::span<const Eigen::Vector2d> corners)
{
    double twice = 0;
    for (std::size_t k = 0; k < corners.size(); ++k) {
        const Eigen::Vector2d &a = corners[k], &b = corners[(k + 1) % corners.size()];
        twice += a.x() * b.y() - a.y() * b.x();
    }
    return std::abs(twice) / 2;
}

} // namespace fettle::geometry
