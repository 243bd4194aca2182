#pragma once

#include "job/job.h"
#include "sampling/noise.h"
#include "surface/patches.h"

#include <Eigen/Core>

#include <cmath>
#include <cstdint>
#include <functional>
#include <ostream>
#include <random>
#include <string>

/// What the programs of pipelines/tables.mk share. They measure; their output is lines "NAME VALUE", one for each
/// trial, which tables-table.cc sets beside the published figures. Lengths in the output are inches, as in the paper.
namespace fettle::study {

constexpr double kInch = 25.4;
/// Measurement error of the simulations: uniform within ±0.005 in (Wang 2007, 4.4).
inline const sampling::TouchNoise kNoise = {sampling::TouchNoise::Kind::uniform, 0.005 * kInch};
/// Places over the longer side of B at which errors are evaluated.
constexpr int kPlacesAcross = 20;

/// z over x-y, mm.
using Height = std::function<double(const Eigen::Vector2d&)>;

/// Random numbers that are the same on every platform.
class Random {
  public:
    explicit Random(std::uint64_t seed) : bits_(seed) {}
    double uniform(double min, double max) { return min + (max - min) * static_cast<double>(bits_() >> 11) * 0x1p-53; }
    Eigen::Vector2d in_box(const Eigen::Vector2d& min, const Eigen::Vector2d& max)
    {
        const double x = uniform(min.x(), max.x());
        return {x, uniform(min.y(), max.y())};
    }

  private:
    std::mt19937_64 bits_;
};

/// A seed for one trial of one cell, far from those of others (the finaliser of splitmix64).
inline std::uint64_t seed_of(std::uint64_t seed, std::uint64_t trial)
{
    std::uint64_t x = seed * 0x9e3779b97f4a7c15ULL + trial;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
    return x ^ (x >> 31);
}

inline Eigen::VectorXd heights(const Height& surface, const Eigen::Matrix2Xd& xy)
{
    Eigen::VectorXd z(xy.cols());
    for (Eigen::Index i = 0; i < z.size(); ++i) z[i] = surface(xy.col(i));
    return z;
}

/// Touches with the simulations' error. @return 3xN
inline Eigen::Matrix3Xd touch(const Height& surface, const Eigen::Matrix2Xd& xy, std::uint64_t seed)
{
    Eigen::Matrix3Xd touches(3, xy.cols());
    touches << xy, (heights(surface, xy) + sampling::draw_noise(kNoise, xy.cols(), seed)).transpose();
    return touches;
}

/// The first patch of a file as a height.
inline Height patch_height(const std::string& file)
{
    return
        [patch = surface::read_patches(file).at(0)](const Eigen::Vector2d& xy) { return surface::height(patch, xy); };
}

/// A rectangle of four boundary points without z.
inline Eigen::Matrix3Xd rectangle(const Eigen::Vector2d& min, const Eigen::Vector2d& max)
{
    Eigen::Matrix3Xd corners(3, 4);
    corners << min.x(), max.x(), max.x(), min.x(), min.y(), min.y(), max.y(), max.y(), 0, 0, 0, 0;
    corners.row(2).setConstant(std::nan(""));
    return corners;
}

inline void write(std::ostream& out, const std::string& name, double value) { out << name << ' ' << value << '\n'; }

} // namespace fettle::study
