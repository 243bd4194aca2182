#include "compare/chebyshev.h"

#include <Eigen/LU>

#include <cmath>
#include <limits>

namespace fettle::compare {

namespace {

// Exchanges needed are a few times the number of parameters; many more mean that rounding makes it cycle.
constexpr int kMaxExchanges = 2000;

// A point closer to the bound than this share of it is a contact: roundoff of the basis solution, with reserve.
constexpr double kRoundoff = 1e-13;

/// A constraint of the basis: a point on one side, or the reach in one coordinate.
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
        const Eigen::Index n = columns.size();
        Eigen::MatrixXd B(n, n);
        Eigen::VectorXd cost(n);
        for (Eigen::Index j = 0; j < n; ++j) {
            B.col(j) = columns[j].a;
            cost[j] = columns[j].cost;
        }
        inverse = B.fullPivLu().inverse();
        multipliers = inverse.col(n - 1);
        y = inverse.transpose() * cost;
    }

    // Ratio test: index of the column that leaves the basis as `entering` enters it; -1: none.
    int find_leaving(const Eigen::VectorXd& entering) const
    {
        const Eigen::VectorXd change = inverse * entering;
        int leaving = -1;
        double best = std::numeric_limits<double>::infinity();
        for (Eigen::Index j = 0; j < change.size(); ++j) {
            if (change[j] <= kRoundoff) continue;
            const double ratio = std::max(multipliers[j], 0.0) / change[j];
            // Ties go to the larger pivot: it keeps the basis well conditioned.
            if (ratio < best || (ratio == best && change[j] > change[leaving])) {
                best = ratio;
                leaving = j;
            }
        }
        return leaving;
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
    for (int exchange = 0; exchange < kMaxExchanges && !step.solved; ++exchange) {
        step.x = -basis.y.head(m);
        step.largest = basis.y[m];
        const Eigen::VectorXd residuals = r + G.transpose() * step.x;
        Eigen::Index worst = 0, farthest = 0;
        const double excess = residuals.cwiseAbs().maxCoeff(&worst) - step.largest;
        const double over_reach = step.x.cwiseAbs().maxCoeff(&farthest) - reach;
        Column entering;
        if (excess > kRoundoff * (std::abs(step.largest) + r.cwiseAbs().maxCoeff()))
            entering = point_column(r, G, worst, residuals[worst] < 0 ? -1 : 1);
        else if (over_reach > kRoundoff * reach)
            entering = reach_column(m, farthest, step.x[farthest] < 0 ? -1 : 1, reach);
        else
            step.solved = true;
        if (step.solved) break;
        const int leaving = basis.find_leaving(entering.a);
        if (leaving < 0) break;
        basis.columns[leaving] = entering;
        basis.update();
    }
    for (std::size_t j = 0; j < basis.columns.size(); ++j) {
        if (basis.multipliers[j] <= kRoundoff) continue;
        if (basis.columns[j].point < 0)
            step.bounded = true;
        else
            step.contacts.push_back(basis.columns[j].point);
    }
    return step;
}

} // namespace fettle::compare
