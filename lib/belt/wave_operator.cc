#include "belt/wave_operator.h"

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

MatrixXd WaveOperator::displacement(const MatrixXd& pressure) const
{
    const Index rows = pressure.rows(), columns = pressure.cols(), first = (columns_ - columns) / 2;
    const Index odd_rows = rows / 2, even_rows = rows - odd_rows;
    const Index odd = is_symmetric_ ? columns / 2 : 0, even = columns - odd;
    const Waves& waves = this->waves(rows);
    // Sums and differences of the columns of either half, then of the rows; a middle row is a sum of one.
    MatrixXd across(rows, columns), folded(rows, columns);
    across.leftCols(even) = pressure.leftCols(even);
    if (is_symmetric_) across.leftCols(even) += pressure.rightCols(even).rowwise().reverse();
    across.rightCols(odd) = pressure.leftCols(odd) - pressure.rightCols(odd).rowwise().reverse();
    folded.topRows(even_rows) = across.topRows(even_rows);
    folded.topRows(odd_rows) += across.bottomRows(odd_rows).colwise().reverse();
    folded.bottomRows(odd_rows) = across.topRows(odd_rows) - across.bottomRows(odd_rows).colwise().reverse();
    // Of each wave a column of cosines and one of sines.
    const Index count = rows_ + 1;
    MatrixXd pressures(columns, 2 * count), displacements(columns, 2 * count);
    const auto part = [&](MatrixXd& all, Index k) {
        return Eigen::Map<MatrixXd, 0, Eigen::OuterStride<>>(all.col(k).data(), columns, count,
                                                             Eigen::OuterStride<>(2 * columns));
    };
    part(pressures, 0).noalias() = folded.topRows(even_rows).transpose() * waves.cosines;
    part(pressures, 1).noalias() = folded.bottomRows(odd_rows).transpose() * waves.sines;
    for (Index f = 0; f < count; ++f) {
        const Eigen::Map<const MatrixXd> even_part(even_.col(f).data(), even_count_, even_count_);
        const Eigen::Map<const MatrixXd> odd_part(odd_.col(f).data(), odd_count_, odd_count_);
        for (const Index k : {2 * f, 2 * f + 1}) {
            displacements.col(k).head(even).noalias() =
                even_part.block(first, first, even, even) * pressures.col(k).head(even);
            displacements.col(k).tail(odd).noalias() =
                odd_part.block(first, first, odd, odd) * pressures.col(k).tail(odd);
        }
    }
    folded.topRows(even_rows).noalias() = waves.cosines * part(displacements, 0).transpose();
    folded.bottomRows(odd_rows).noalias() = waves.sines * part(displacements, 1).transpose();
    across.topRows(even_rows) = folded.topRows(even_rows);
    across.bottomRows(odd_rows) = (folded.topRows(odd_rows) - folded.bottomRows(odd_rows)).colwise().reverse();
    across.topRows(odd_rows) += folded.bottomRows(odd_rows);
    MatrixXd displacement(rows, columns);
    displacement.leftCols(even) = across.leftCols(even);
    displacement.rightCols(odd) = (across.leftCols(odd) - across.rightCols(odd)).rowwise().reverse();
    displacement.leftCols(odd) += across.rightCols(odd);
    return displacement;
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
