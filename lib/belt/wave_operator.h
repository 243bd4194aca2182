#pragma once

#include <Eigen/Core>

#include <map>
#include <utility>
#include <vector>

namespace fettle::belt {

/// Maps the pressure on a grid of cells to a displacement, wave by wave along the rows: any compliance that does not
/// vary along them, such as that of a layer with sides. The grid is periodic at twice its length, which leaves the
/// influence between its cells unchanged. There is one wave more than rows. Where the compliance is the same from
/// either end of the columns, the even and the odd part of a pressure do not mix: two matrices of half the size do. The
/// same along the rows, whose waves are cosines and sines: products of small matrices, which up to some hundred cells
/// are quicker than Fourier transforms (tests/bench/contact_bench.cc).
class WaveOperator {
  public:
    /// @param spectrum  compliance of each wave (column), a matrix of columns x columns, mm/MPa
    WaveOperator(Eigen::Index rows, Eigen::Index columns, const Eigen::MatrixXd& spectrum);

    /// Not thread-safe.
    /// @param pressure  of all rows or of some next to each other, and of all columns or of some in the middle, as many
    /// left out on either side: the pressure elsewhere is 0   @return  displacement of the same cells
    Eigen::MatrixXd displacement(const Eigen::MatrixXd& pressure) const;

  private:
    struct Waves {
        Eigen::MatrixXd cosines, sines;
    };
    const Waves& waves(Eigen::Index count) const;

    Eigen::Index rows_, columns_;
    bool is_symmetric_;
    Eigen::Index odd_count_, even_count_;         ///< the even part has the middle column; without symmetry it has all
    Eigen::MatrixXd even_, odd_;                  ///< the spectrum for either part
    mutable std::map<Eigen::Index, Waves> waves_; ///< by the number of rows that they are for
};

/// Weights of a compliance at phases from row to row (rows of the result) for each wave of a grid (columns).
/// @param nodes  phases and the weights of their quadrature over the mean of a half wave, from 0 to π
Eigen::MatrixXd wave_weights(const std::vector<std::pair<double, double>>& nodes, Eigen::Index rows);

/// Share of the influence from row to row in each wave: the cosine transform of one side of an even sequence.
/// @param influence  on rows 0, 1, …; a sequence a column   @return  a wave a row
Eigen::MatrixXd wave_transform(const Eigen::MatrixXd& influence);

/// The inverse of wave_transform() for influences that are rows.
/// @param spectrum  a wave a column   @return  from row to row, a distance a column
Eigen::MatrixXd influence_of_waves(const Eigen::MatrixXd& spectrum);

} // namespace fettle::belt
