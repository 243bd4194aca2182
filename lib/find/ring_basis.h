#pragma once

#include <Eigen/Core>

#include <optional>
#include <vector>

/// Shared by the files of RingFit: the scaled points of a ring, and linear least squares on them.
namespace fettle::find {

inline constexpr std::size_t kHighestDegree = 4;
inline constexpr Eigen::Index kMaxTerms = 15;   ///< of a polynomial of that degree
inline constexpr Eigen::Index kCreaseTerms = 3; ///< of a crease
inline constexpr double kRingStartCutoff = 5;   ///< Tukey's, of the weights to start from, standard deviations
inline constexpr double kMinRingSigmas = 0.5;   ///< a residual spread below half the noise is chance
inline constexpr double kMinRingSpread = 1e-9;  ///< mm: keeps weights finite where a synthetic ring is fitted exactly
inline constexpr double kRingRidge = 1e-9;      ///< of the trace: fixes directions that few points do not determine

/// The line across which a surface bends: across · p = offset.
struct Crease {
    Eigen::Vector2d across; ///< unit
    double offset;

    /// Distance beyond the line, 0 before it; times 1, the place along the line, and itself: how two smooth surfaces
    /// that meet in the line differ.
    Eigen::Vector3d terms(double x, double y) const;
};

/// Points of a ring; their number is a multiple of four.
struct Ring {
    Eigen::Matrix2Xd xy; ///< scaled
    Eigen::VectorXd z;   ///< about its median
    Eigen::VectorXd near;
    double sigma;
    double independent; ///< number of independent points
};

/// The largest number of points up to `count` that fills lanes of four.
inline Eigen::Index count_in_lanes(Eigen::Index count) { return count / 4 * 4; }

/// An even subset of the points.
Ring thinned(const Ring& ring, Eigen::Index max_count);

inline Eigen::Index terms_of(int degree) { return Eigen::Index(degree + 1) * (degree + 2) / 2; }

/// Monomials x^a y^b of total degree up to `degree`; those of a lower degree come first.
void monomials(double x, double y, int degree, double* row);

// Upper bound of the number of functions, by which matrices and vectors of coefficients are on the stack.
inline constexpr int kMaxRingTerms = int(kMaxTerms + kCreaseTerms);
using RingCoefficients = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kMaxRingTerms, 1>;
using RingMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, kMaxRingTerms, kMaxRingTerms>;

/// A surface's functions at a ring's points, a column each: the crease's terms, if it has one, then the monomials.
class RingColumns {
  public:
    RingColumns(const double* data, Eigen::Index rows, Eigen::Index count) : data_(data), rows_(rows), count_(count) {}

    Eigen::Index count() const { return count_; }

    struct NormalEquations {
        RingMatrix matrix; ///< lower half
        RingCoefficients right;

        /// The normal equations of the first columns.
        NormalEquations head(Eigen::Index count) const;
        RingCoefficients solution() const;
        RingMatrix inverse() const;
    };
    NormalEquations normal_equations(const Eigen::VectorXd& z, const Eigen::VectorXd& weights) const;

    /// Coefficients by weighted least squares.
    RingCoefficients solve(const Eigen::VectorXd& z, const Eigen::VectorXd& weights) const
    {
        return normal_equations(z, weights).solution();
    }

    /// z less the functions.
    Eigen::VectorXd residuals(const Eigen::VectorXd& z, const RingCoefficients& coefficients) const;

  private:
    const double* data_;
    Eigen::Index rows_, count_;
};

/// The functions of all surfaces up to a degree: those of one are columns next to each other.
class RingBasis {
  public:
    RingBasis(const Eigen::Matrix2Xd& xy, int degree);
    void set_crease(const Eigen::Matrix2Xd& xy, const Crease& crease);

    RingColumns of(int degree, bool is_creased) const
    {
        const Eigen::Index first = is_creased ? 0 : kCreaseTerms;
        return {columns_.col(first).data(), columns_.rows(), kCreaseTerms + terms_of(degree) - first};
    }

  private:
    Eigen::MatrixXd columns_;
};

/// Sizes of residuals, chosen one by one.
class ChosenSizes {
  public:
    explicit ChosenSizes(Eigen::Index max_count) : sizes_(std::size_t(max_count)) {}

    void add(double residual, bool is_chosen)
    {
        sizes_[count_] = std::abs(residual);
        count_ += is_chosen; // without a branch, which would be mispredicted
    }
    bool empty() const { return count_ == 0; }
    double quantile(double share);
    double median();

  private:
    std::vector<double> sizes_;
    std::size_t count_ = 0;
};

double quantile_of_sizes(const Eigen::VectorXd& residuals, double share);

/// Weights for the next fit after residuals, by Huber, with the spread of the chosen points.
/// @param chosen  1 or 0   @param min_spread  mm
void reweigh(Eigen::VectorXd& weights, const Eigen::VectorXd& residuals, const Eigen::VectorXd& chosen,
             double min_spread);

} // namespace fettle::find
