#include "compare/chebyshev.h"

#include <Eigen/LU>

#include <cmath>
#include <limits>

namespace fettle {

namespace {

// Exchanges needed are a few times the number of parameters; many more mean that rounding makes it cycle.
constexpr int kMostExchanges = 2000;

// A point closer to the bound than this share of it touches: roundoff of the basis solution, with reserve.
constexpr double kRoundoff = 1e-13;

/// One constraint of the basis: a point on one side, or the reach in one coordinate.
struct Column {
    Eigen::Index point = -1; ///< -1: the reach
    Eigen::VectorXd a;       ///< (s g, 1), or (s e_k, 0)
    double cost = 0;         ///< s r, or -reach
};

Column point_column(const Eigen::VectorXd& r, const Eigen::MatrixXd& G, Eigen::Index i, double side)
{
    Column column{i, Eigen::VectorXd(G.rows() + 1), side * r[i]};
    column.a << side * G.col(i), 1;
    return column;
}

Column reach_column(Eigen::Index parameters, Eigen::Index k, double side, double reach)
{
    Column column{-1, Eigen::VectorXd::Zero(parameters + 1), -reach};
    column.a[k] = side;
    return column;
}

/// Columns of the basis, inverted anew at each exchange: with at most six rows that is cheap and keeps no errors.
struct Basis {
    std::vector<Column> columns;
    Eigen::MatrixXd inverse;
    Eigen::VectorXd multipliers; ///< λ
    Eigen::VectorXd y;           ///< (-x, largest)

    void update()
    {
        const auto n = static_cast<Eigen::Index>(columns.size());
        Eigen::MatrixXd B(n, n);
        Eigen::VectorXd cost(n);
        for (Eigen::Index j = 0; j < n; ++j) {
            B.col(j) = columns[static_cast<std::size_t>(j)].a;
            cost[j] = columns[static_cast<std::size_t>(j)].cost;
        }
        inverse = B.fullPivLu().inverse();
        multipliers = inverse.col(n - 1);
        y = inverse.transpose() * cost;
    }

    // The column that the entering one drives out first; -1: none.
    int leaving(const Eigen::VectorXd& entering) const
    {
        const Eigen::VectorXd change = inverse * entering;
        int least = -1;
        double best = std::numeric_limits<double>::infinity();
        for (Eigen::Index j = 0; j < change.size(); ++j) {
            if (change[j] <= kRoundoff) continue;
            const double ratio = std::max(multipliers[j], 0.0) / change[j];
            // Ties go to the larger pivot: it keeps the basis well conditioned.
            if (ratio < best || (ratio == best && change[j] > change[least])) {
                best = ratio;
                least = static_cast<int>(j);
            }
        }
        return least;
    }
};

Basis first_basis(const Eigen::VectorXd& r, const Eigen::MatrixXd& G, double reach)
{
    Eigen::Index farthest = 0;
    r.cwiseAbs().maxCoeff(&farthest);
    const double side = r[farthest] < 0 ? -1 : 1;
    Basis basis;
    for (Eigen::Index k = 0; k < G.rows(); ++k) // on the side that leaves the multipliers positive
        basis.columns.push_back(reach_column(G.rows(), k, side * G(k, farthest) > 0 ? -1 : 1, reach));
    basis.columns.push_back(point_column(r, G, farthest, side));
    basis.update();
    return basis;
}

} // namespace

ChebyshevStep chebyshev_step(const Eigen::VectorXd& r, const Eigen::MatrixXd& G, double reach)
{
    const Eigen::Index m = G.rows();
    Basis basis = first_basis(r, G, reach);
    ChebyshevStep step;
    for (int exchange = 0; exchange < kMostExchanges && !step.solved; ++exchange) {
        step.x = -basis.y.head(m);
        step.largest = basis.y[m];
        const Eigen::VectorXd moved = r + G.transpose() * step.x;
        Eigen::Index worst = 0, beyond = 0;
        const double excess = moved.cwiseAbs().maxCoeff(&worst) - step.largest;
        const double over_reach = step.x.cwiseAbs().maxCoeff(&beyond) - reach;
        Column entering;
        if (excess > kRoundoff * (std::abs(step.largest) + r.cwiseAbs().maxCoeff()))
            entering = point_column(r, G, worst, moved[worst] < 0 ? -1 : 1);
        else if (over_reach > kRoundoff * reach)
            entering = reach_column(m, beyond, step.x[beyond] < 0 ? -1 : 1, reach);
        else
            step.solved = true;
        if (step.solved) break;
        const int out = basis.leaving(entering.a);
        if (out < 0) break;
        basis.columns[static_cast<std::size_t>(out)] = entering;
        basis.update();
    }
    for (std::size_t j = 0; j < basis.columns.size(); ++j) {
        if (basis.multipliers[static_cast<Eigen::Index>(j)] <= kRoundoff) continue;
        if (basis.columns[j].point < 0)
            step.bounded = true;
        else
            step.contacts.push_back(basis.columns[j].point);
    }
    return step;
}

} // namespace fettle
