#pragma once

#include <Eigen/Core>

#include <utility>
#include <vector>

namespace fettle::belt {

/// Maps the pressure on a grid of cells to a displacement, wave by wave along the rows: any compliance that does not
/// vary along them, such as that of a layer with sides. The grid is periodic at twice its length, which leaves the
/// influence between its cells unchanged. There is one wave more than rows.
class WaveOperator {
  public:
    WaveOperator(Eigen::Index rows, Eigen::Index columns);

    /// Compliance of each wave (column), a matrix of columns x columns; 0 at first. mm/MPa
    Eigen::MatrixXd& spectrum() { return spectrum_; }
    Eigen::MatrixXd displacement(const Eigen::MatrixXd& pressure) const;

  private:
    Eigen::MatrixXd waves_; ///< cosine and sine of each wave over the grid's rows, in alternate rows
    Eigen::MatrixXd spectrum_;
};

/// Weights of a compliance at phases from row to row (rows of the result) for each wave of a grid (columns).
/// @param nodes  phases and the weights of their quadrature over the mean of a half wave, from 0 to π
Eigen::MatrixXd wave_weights(const std::vector<std::pair<double, double>>& nodes, Eigen::Index rows);

/// Share of the influence from row to row in each wave: the cosine transform of one side of an even sequence.
/// @param influence  on rows 0, 1, …; a sequence a column   @return  a wave a row
Eigen::MatrixXd wave_transform(const Eigen::MatrixXd& influence);

} // namespace fettle::belt
