#include "belt/wave_operator.h"

#include "core/product.h"

#include <cmath>
#include <numbers>

namespace fettle::belt {

using Eigen::Index;
using Eigen::MatrixXd;
using std::numbers::pi;

namespace {

/// Rounding of a compliance that is the same from either end.
constexpr double kSymmetryTolerance = 1e-9;

bool is_symmetric(const MatrixXd& spectrum, Index columns)
{
    for (Index f = 0; f < spectrum.cols(); ++f) {
        const Eigen::Map<const MatrixXd> wave(spectrum.col(f).data(), columns, columns);
        if (!((wave - wave.reverse()).cwiseAbs().maxCoeff() <= kSymmetryTolerance * wave.cwiseAbs().maxCoeff()))
            return false;
    }
    return true;
}

} // namespace

WaveOperator::WaveOperator(Index rows, Index columns, const MatrixXd& spectrum)
    : rows_(rows), columns_(columns), is_symmetric_(is_symmetric(spectrum, columns)),
      odd_count_(is_symmetric_ ? columns / 2 : 0), even_count_(columns - odd_count_),
      even_(even_count_ * even_count_, rows + 1), odd_(odd_count_ * odd_count_, rows + 1)
{
    const double factor = is_symmetric_ ? 0.5 : 1; // the parts are sums of two
    for (Index f = 0; f <= rows; ++f) {
        const Eigen::Map<const MatrixXd> wave(spectrum.col(f).data(), columns, columns);
        const MatrixXd reversed = wave.rowwise().reverse();
        MatrixXd even = factor * wave.topLeftCorner(even_count_, even_count_);
        even.leftCols(odd_count_) += factor * reversed.topLeftCorner(even_count_, odd_count_);
        even_.col(f) = even.reshaped();
        odd_.col(f) = (factor * (wave - reversed).topLeftCorner(odd_count_, odd_count_)).reshaped();
    }
}

/// Cosines and sines of each wave (column) at the rows of the first half, from the middle of `count` rows.
const WaveOperator::Waves& WaveOperator::waves(Index count) const
{
    Waves& waves = waves_[count];
    if (waves.cosines.size() > 0) return waves;
    waves.cosines.resize(count - count / 2, rows_ + 1);
    waves.sines.resize(count / 2, rows_ + 1);
    for (Index f = 0; f <= rows_; ++f)
        for (Index i = 0; i < waves.cosines.rows(); ++i) {
            const double phase = pi * static_cast<double>(f * (2 * i + 1 - count)) / (2.0 * static_cast<double>(rows_));
            waves.cosines(i, f) = std::cos(phase);
            if (i < waves.sines.rows()) waves.sines(i, f) = std::sin(phase);
        }
    return waves;
}

/// Fields are transposed here: cells of a row lie one after the other.
MatrixXd WaveOperator::displacement(const MatrixXd& pressure) const
{
    const Index rows = pressure.rows(), columns = pressure.cols(), first = (columns_ - columns) / 2;
    const Index odd_rows = rows / 2, even_rows = rows - odd_rows;
    const Index odd = is_symmetric_ ? columns / 2 : 0, even = columns - odd;
    const Waves& waves = this->waves(rows);
    // Sums and differences of the columns of either half, then of the rows; a middle row is a sum of one.
    const MatrixXd transposed = pressure.transpose();
    MatrixXd across(columns, rows), folded(columns, rows);
    double* const odd_folded = folded.data() + columns * even_rows;
    across.topRows(even) = transposed.topRows(even);
    if (is_symmetric_) across.topRows(even) += transposed.bottomRows(even).colwise().reverse();
    across.bottomRows(odd) = transposed.topRows(odd) - transposed.bottomRows(odd).colwise().reverse();
    folded.leftCols(even_rows) = across.leftCols(even_rows);
    folded.leftCols(odd_rows) += across.rightCols(odd_rows).rowwise().reverse();
    folded.rightCols(odd_rows) = across.leftCols(odd_rows) - across.rightCols(odd_rows).rowwise().reverse();
    // Each wave has a column of cosines and one of sines.
    const Index count = rows_ + 1, pair = 2 * columns;
    MatrixXd pressures(columns, 2 * count), displacements(columns, 2 * count);
    core::multiply({folded.data(), columns}, {waves.cosines.data(), 1, even_rows}, columns, even_rows, count,
                   pressures.data(), pair);
    core::multiply({odd_folded, columns}, {waves.sines.data(), 1, odd_rows}, columns, odd_rows, count,
                   pressures.data() + columns, pair);
    for (Index f = 0; f < count; ++f) {
        const double* from = pressures.data() + f * pair;
        double* to = displacements.data() + f * pair;
        core::multiply({even_.col(f).data() + first * (even_count_ + 1), even_count_}, {from, 1, columns}, even, even,
                       2, to, columns);
        core::multiply({odd_.col(f).data() + first * (odd_count_ + 1), odd_count_}, {from + even, 1, columns}, odd, odd,
                       2, to + even, columns);
    }
    core::multiply({displacements.data(), pair}, {waves.cosines.data(), even_rows, 1}, columns, count, even_rows,
                   folded.data(), columns);
    core::multiply({displacements.data() + columns, pair}, {waves.sines.data(), odd_rows, 1}, columns, count, odd_rows,
                   odd_folded, columns);
    across.leftCols(even_rows) = folded.leftCols(even_rows);
    across.rightCols(odd_rows) = (folded.leftCols(odd_rows) - folded.rightCols(odd_rows)).rowwise().reverse();
    across.leftCols(odd_rows) += folded.rightCols(odd_rows);
    MatrixXd displacement(columns, rows);
    displacement.topRows(even) = across.topRows(even);
    displacement.bottomRows(odd) = (across.topRows(odd) - across.bottomRows(odd)).colwise().reverse();
    displacement.topRows(odd) += across.bottomRows(odd);
    return displacement.transpose();
}

MatrixXd wave_transform(const MatrixXd& influence)
{
    const Index rows = influence.rows();
    MatrixXd transform(rows + 1, rows);
    for (Index f = 0; f <= rows; ++f)
        for (Index m = 0; m < rows; ++m)
            transform(f, m) =
                (m == 0 ? 1 : 2) * std::cos(pi * (f * m) / rows) * (f == 0 || f == rows ? 1 : 2) / (2.0 * rows);
    return transform * influence;
}

MatrixXd influence_of_waves(const MatrixXd& spectrum)
{
    const Index rows = spectrum.cols() - 1;
    MatrixXd cosines(rows + 1, rows);
    for (Index m = 0; m < rows; ++m)
        for (Index f = 0; f <= rows; ++f) cosines(f, m) = std::cos(pi * (f * m) / rows);
    return spectrum * cosines;
}

MatrixXd wave_weights(const std::vector<std::pair<double, double>>& nodes, Index rows)
{
    MatrixXd influence(rows, std::ssize(nodes));
    for (Index k = 0; k < influence.cols(); ++k)
        for (Index m = 0; m < rows; ++m) influence(m, k) = nodes[k].second * std::cos(m * nodes[k].first);
    return wave_transform(influence).transpose();
}

} // namespace fettle::belt
