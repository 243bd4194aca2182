#include "belt/wave_operator.h"

#include <cmath>
#include <numbers>

namespace fettle::belt {

using Eigen::Index;
using Eigen::MatrixXd;
using std::numbers::pi;

WaveOperator::WaveOperator(Index rows, Index columns)
    : waves_(2 * (rows + 1), rows), spectrum_(MatrixXd::Zero(columns * columns, rows + 1))
{
    for (Index f = 0; f <= rows; ++f)
        for (Index i = 0; i < rows; ++i) {
            waves_(2 * f, i) = std::cos(pi * (f * i) / rows);
            waves_(2 * f + 1, i) = std::sin(pi * (f * i) / rows);
        }
}

MatrixXd WaveOperator::displacement(const MatrixXd& pressure) const
{
    const Index columns = pressure.cols();
    MatrixXd amplitudes = (waves_ * pressure).transpose();
    for (Index f = 0; f < spectrum_.cols(); ++f) {
        const Eigen::Map<const MatrixXd> compliance_of_wave(spectrum_.col(f).data(), columns, columns);
        amplitudes.middleCols(2 * f, 2) = (compliance_of_wave * amplitudes.middleCols(2 * f, 2)).eval();
    }
    return waves_.transpose() * amplitudes.transpose();
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

MatrixXd wave_weights(const std::vector<std::pair<double, double>>& nodes, Index rows)
{
    MatrixXd influence(rows, std::ssize(nodes));
    for (Index k = 0; k < influence.cols(); ++k)
        for (Index m = 0; m < rows; ++m) influence(m, k) = nodes[k].second * std::cos(m * nodes[k].first);
    return wave_transform(influence).transpose();
}

} // namespace fettle::belt
