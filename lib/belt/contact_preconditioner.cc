#include "belt/contact_preconditioner.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fettle::belt {

using Eigen::ArrayXXd;
using Eigen::Index;

namespace {

/// What a longest wave (column 0: half of it on all cells) and a shortest one (column 1: from cell to cell) have so
/// many cells away from their crest, on either side. They fall off towards the last cell (Fejér 1900): cut off there,
/// the influence would have waves that seem to be pushed back.
Eigen::MatrixX2d waves(Index count)
{
    Eigen::MatrixX2d waves(count, 2);
    for (Index i = 0; i < count; ++i) {
        const double share = static_cast<double>(i) / static_cast<double>(count), sides = i == 0 ? 1 : 2;
        waves.row(i) << std::cos(std::numbers::pi * share), i % 2 == 0 ? 1 : -1;
        waves.row(i) *= sides * (1 - share);
    }
    return waves;
}

} // namespace

ContactPreconditioner::ContactPreconditioner(const Eigen::MatrixXd& influence)
    : compliance_(waves(influence.rows()).transpose() * influence * waves(influence.cols()))
{
    // An incompressible layer hardly yields to waves that are long both ways.
    compliance_(0, 0) = std::max(compliance_(0, 0), compliance_(1, 1));
    fit(0);
}

void ContactPreconditioner::fit(double own)
{
    const Eigen::Array22d stiffness = 1 / (compliance_ + own);
    const double sum = stiffness.sum();
    middle_ = sum / 4;
    row_ = (2 * stiffness.row(0).sum() - sum) / 8;
    column_ = (2 * stiffness.col(0).sum() - sum) / 8;
    corner_ = (2 * (stiffness(0, 0) + stiffness(1, 1)) - sum) / 16;
}

ArrayXXd ContactPreconditioner::operator()(const ArrayXXd& gap) const
{
    const Index rows = gap.rows(), columns = gap.cols();
    ArrayXXd pressure = ArrayXXd::Zero(rows, columns), along(rows, columns);
    // Each column with those on either side of it, for the cell's own row, then for the rows beside it.
    const auto across = [&](double own, double beside) {
        along = own * gap;
        along.rightCols(columns - 1) += beside * gap.leftCols(columns - 1);
        along.leftCols(columns - 1) += beside * gap.rightCols(columns - 1);
    };
    across(row_, corner_);
    pressure.bottomRows(rows - 1) += along.topRows(rows - 1);
    pressure.topRows(rows - 1) += along.bottomRows(rows - 1);
    across(middle_, column_);
    return pressure + along;
}

} // namespace fettle::belt
