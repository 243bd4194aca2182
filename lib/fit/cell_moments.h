#pragma once

#include "surface/band.h"
#include "surface/surface.h"

#include <Eigen/Core>

#include <cstdint>
#include <span>
#include <vector>

namespace fettle {

/// A point by its place in a spline's grid.
struct CellPoint {
    std::int32_t cell = 0; ///< column-major
    double u = 0, v = 0;   ///< from the cell's middle, in cells: -1/2 … 1/2
    double z = 0;          ///< mm
};

/// Heights of a spline as a polynomial in each cell: 16 coefficients a cell, of u^a v^b at 4 b + a.
std::vector<double> cell_polynomials(const Bspline& spline);

/// r_i = z_i - spline. @param polynomials  cell_polynomials()
void residuals(std::span<const CellPoint> points, const std::vector<double>& polynomials, double* r);

/// Sums over the points of each cell. Products of two basis functions are polynomials of degree 6 in u and v, so 49
/// moments of a point stand for its 16 x 16 products:
///     matrix (a, b) = Σ w u^a v^b, a, b <= 6;  right (a, b) = Σ w r u^a v^b, a, b <= 3;  and Σ w r².
class CellMoments {
  public:
    explicit CellMoments(const Bspline& grid);

    void add(std::span<const CellPoint> points, const double* r, const double* w);
    void add(const CellMoments& other);

    /// Σ w of each cell, cells_u x cells_v.
    Eigen::MatrixXd weights() const;

    /// Σ s w g gᵀ with g the basis at the points and s a factor for each cell.
    BandMatrix matrix(const Bspline& grid, const Eigen::MatrixXd& s) const;
    Eigen::VectorXd right(const Eigen::MatrixXd& s) const; ///< Σ s w r g
    double square(const Eigen::MatrixXd& s) const;         ///< Σ s w r²

  private:
    Eigen::Index cells_u_, cells_v_;
    std::vector<double> sums_;
};

} // namespace fettle
