#pragma once

#include <Eigen/Core>

namespace fettle::belt {

/// Approximate inverse of the compliance of a layer and of what is ground off beneath it, for conjugate gradients. A
/// layer yields to a wave about as much as the wave is long, so that without one the short waves, to which it hardly
/// yields, take most of the iterations. This one is a stencil of 3 x 3 cells that divides the longest and the shortest
/// waves along rows and columns by about their compliance, and those between by one between them. It is symmetric and
/// positive definite, also on a part of the cells.
class ContactPreconditioner {
  public:
    /// Of a layer that yields to all waves alike: the gaps' directions stay as they are.
    ContactPreconditioner() : compliance_(Eigen::Array22d::Ones()) { fit(0); }
    /// @param influence  displacement of a cell under the pressure of one so many rows and columns away, mm/MPa
    explicit ContactPreconditioner(const Eigen::MatrixXd& influence);

    /// Fits the stencil to the layer and what yields beside it.
    /// @param own  mean compliance of the cells' own, mm/MPa, ≥ 0: slope of the depth that is ground off; at first 0
    void fit(double own);
    /// @param gap  on the cells, 0 where they are not in contact, mm   @return  pressure, MPa
    Eigen::ArrayXXd operator()(const Eigen::ArrayXXd& gap) const;

  private:
    Eigen::Array22d compliance_;            ///< to the longest and the shortest waves, mm/MPa
    double middle_, row_, column_, corner_; ///< of the stencil, MPa/mm
};

} // namespace fettle::belt
