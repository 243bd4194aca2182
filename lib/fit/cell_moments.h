#pragma once

#include "surface/band.h"
#include "surface/surface.h"

#include <Eigen/Core>

#include <cstdint>
#include <span>
#include <vector>

namespace fettle::fit {

/// A point in the coordinates of a cell of a spline's grid.
struct CellPoint {
    std::int32_t cell = 0; ///< column-major index
    double u = 0, v = 0;   ///< from the cell's middle, in cells: -1/2 … 1/2
    double z = 0;          ///< mm
};

/// Heights of a spline as a polynomial in each cell: 16 coefficients per cell, that of u^a v^b at index 4 b + a.
std::vector<double> cell_polynomials(const surface::Bspline& spline);

/// r_i = z_i - f(x_i, y_i), mm. @param polynomials  the spline f's, from cell_polynomials()
void residuals(std::span<const CellPoint> points, const std::vector<double>& polynomials, double* r);

/// Weighted moments of the points in each cell, from which the normal equations of a bicubic spline follow. Products of
/// two basis functions are polynomials of degree 6 in u and v, so 49 moments replace 16 x 16 products of a point:
///     matrix (a, b) = Σ w u^a v^b, a, b <= 6;  right (a, b) = Σ w r u^a v^b, a, b <= 3;  and Σ w r².
class CellMoments {
  public:
    explicit CellMoments(const surface::Bspline& grid);

    void add(std::span<const CellPoint> points, const double* r, const double* w);
    void add(const CellMoments& other);

    /// Sum of weights Σ w of each cell, cells_u x cells_v.
    Eigen::MatrixXd weights() const;
    /// Mean residual Σ w r / Σ w of each cell, mm; 0 without points.
    Eigen::MatrixXd mean_residuals() const;

    /// Σ s w g gᵀ with g the basis functions at a point and s a factor for each cell.
    surface::BandMatrix normal_matrix(const surface::Bspline& grid, const Eigen::MatrixXd& s) const;
    Eigen::VectorXd right_side(const Eigen::MatrixXd& s) const; ///< Σ s w r g
    double square_sum(const Eigen::MatrixXd& s) const;          ///< Σ s w r²

  private:
    Eigen::Index cells_u_, cells_v_;
    std::vector<double> sums_;
};

} // namespace fettle::fit
