#include "robot/avoid_tilts.h"

#include "robot/layered_search.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace fettle {

namespace {

using Eigen::Index, Eigen::Vector2d;

// Poses over which a tilt fades: one to two degrees from one to the next for the largest.
constexpr double kRamp = 32;
// Beyond so many ramps nothing is left of a tilt (2 %), and a stretch of the path ends.
constexpr std::size_t kFaded = static_cast<std::size_t>(4 * kRamp);

// The first search: of so many poses one has a say, with tilts so far apart.
constexpr std::size_t kFirstStep = 16;
constexpr double kFirstSpacing = std::numbers::pi / 24;
// Each later one has the tilts within so many steps of those found before.
constexpr int kAround = 2;
// The last ones, for every pose, go on until the tilts are that near to each other: finer steps are lost in what
// robots repeat.
constexpr double kLastSpacing = std::numbers::pi / 720;

enum class Known : std::uint8_t { nothing, clear, blocked };

// A pose that has a say, and the tilts it may have.
struct Layer {
    std::size_t pose = 0;
    std::vector<Vector2d> tilts;
    std::vector<Known> known;
};

// A stretch of the path that is led around on its own.
class Stretch {
  public:
    Stretch(const Trials& trials, const std::vector<double>& depth, const AvoidOptions& options, std::size_t first,
            std::size_t end)
        : trials_(trials), depth_(depth), options_(options), first_(first), end_(end), tilts_(end - first),
          blocked_(end - first)
    {
        for (Vector2d& tilt : tilts_) tilt.setZero();
    }

    void search()
    {
        std::size_t step = kFirstStep;
        double spacing = kFirstSpacing;
        find(layers(step, [&](std::size_t) { return disc(); }));
        while (step > 1 || spacing > kLastSpacing) {
            step = std::max<std::size_t>(1, step / 2);
            spacing /= 2;
            find(layers(step, [&](std::size_t pose) { return around(tilts_[pose - first_], spacing); }));
        }
    }

    const Vector2d& tilt(std::size_t pose) const { return tilts_[pose - first_]; }

  private:
    // All tilts that are allowed, on a square grid.
    std::vector<Vector2d> disc() const
    {
        std::vector<Vector2d> tilts;
        const int most = static_cast<int>(std::floor(options_.most_tilt / kFirstSpacing * (1 + 1e-9)));
        for (int x = -most; x <= most; ++x)
            for (int y = -most; y <= most; ++y)
                if (x * x + y * y <= most * most) tilts.push_back(kFirstSpacing * Vector2d(x, y));
        return tilts;
    }

    std::vector<Vector2d> around(const Vector2d& middle, double spacing) const
    {
        std::vector<Vector2d> tilts;
        for (int x = -kAround; x <= kAround; ++x)
            for (int y = -kAround; y <= kAround; ++y) {
                const Vector2d tilt = middle + spacing * Vector2d(x, y);
                if (tilt.norm() <= options_.most_tilt * (1 + 1e-9)) tilts.push_back(tilt);
            }
        if (middle.norm() < 2 * kAround * spacing) tilts.push_back(Vector2d::Zero()); // the grid may miss it
        return tilts;
    }

    // Where the stretch ends within the path, it ends as the path was.
    bool is_fixed(std::size_t pose) const
    {
        return (pose == first_ && first_ > 0) || (pose + 1 == end_ && end_ < depth_.size());
    }

    template <class Tilts>
    std::vector<Layer> layers(std::size_t step, const Tilts& tilts) const
    {
        std::vector<Layer> all;
        const auto add = [&](std::size_t pose) {
            if (!all.empty() && all.back().pose == pose) return;
            Layer layer{pose, is_fixed(pose) ? std::vector<Vector2d>{Vector2d::Zero()} : tilts(pose), {}};
            for (const Vector2d& tilt : layer.tilts)
                layer.known.push_back(blocked_[pose - first_].holds({tilt, 0}) ? Known::blocked : Known::nothing);
            all.push_back(std::move(layer));
        };
        add(first_);
        for (std::size_t from = first_; from < end_; from += step) {
            const auto begin = depth_.begin() + static_cast<std::ptrdiff_t>(from);
            const auto last = depth_.begin() + static_cast<std::ptrdiff_t>(std::min(from + step, end_));
            add(static_cast<std::size_t>(std::max_element(begin, last) - depth_.begin()));
        }
        add(end_ - 1);
        return all;
    }

    // The shortest way; a tilt that nobody has tried counts as clear.
    static std::vector<std::size_t> shortest(const std::vector<Layer>& layers)
    {
        LayeredSearch search;
        for (std::size_t k = 0; k < layers.size(); ++k) {
            const Layer& here = layers[k];
            const double reach =
                double(layers[std::min(k + 1, layers.size() - 1)].pose - layers[k > 0 ? k - 1 : 0].pose) / 2;
            search.add(here.tilts.size(), [&](std::size_t from, std::size_t to) -> LayeredSearch::Length {
                const double stay = reach * here.tilts[to].squaredNorm() / (kRamp * kRamp);
                const int fault = here.known[to] == Known::blocked ? 1 : 0;
                if (k == 0) return {fault, stay};
                const double way = double(here.pose - layers[k - 1].pose);
                return {fault, stay + (here.tilts[to] - layers[k - 1].tilts[from]).squaredNorm() / way};
            });
        }
        return search.path();
    }

    void find(std::vector<Layer> layers)
    {
        std::vector<std::size_t> path;
        for (bool learnt = true; learnt;) {
            path = shortest(layers);
            learnt = false;
            for (std::size_t k = 0; k < layers.size(); ++k)
                if (layers[k].known[path[k]] == Known::nothing && try_out(layers[k], path[k])) learnt = true;
        }
        for (std::size_t k = 0; k + 1 < layers.size(); ++k) {
            const Vector2d &a = layers[k].tilts[path[k]], &b = layers[k + 1].tilts[path[k + 1]];
            const std::size_t from = layers[k].pose, way = layers[k + 1].pose - from;
            for (std::size_t i = 0; i <= way; ++i) tilts_[from - first_ + i] = a + (b - a) * (double(i) / double(way));
        }
    }

    // Tries a tilt. @return  is it blocked?
    bool try_out(Layer& layer, std::size_t tilt)
    {
        Known& known = layer.known[tilt];
        const bool as_it_was = layer.tilts[tilt].isZero(0);
        if (as_it_was) {
            known = depth_[layer.pose] > 0 ? Known::blocked : Known::clear;
            if (known == Known::clear) return false;
        }
        Blocked& blocked = blocked_[layer.pose - first_];
        const auto pose = static_cast<Index>(layer.pose);
        const CellJoints q = trials_.look(pose, {layer.tilts[tilt], 0}, trials_.near(pose), blocked);
        if (!as_it_was) known = q.hasNaN() ? Known::blocked : Known::clear;
        if (known == Known::clear) return false;
        for (std::size_t i = 0; i < layer.tilts.size(); ++i)
            if (layer.known[i] == Known::nothing && blocked.holds({layer.tilts[i], 0})) layer.known[i] = Known::blocked;
        return true;
    }

    const Trials& trials_;
    const std::vector<double>& depth_;
    const AvoidOptions& options_;
    std::size_t first_, end_;
    std::vector<Vector2d> tilts_;  ///< found so far
    std::vector<Blocked> blocked_; ///< of each pose
};

// Stretches from which a tilt does not reach the next, as first pose and the one behind the last.
std::vector<std::pair<std::size_t, std::size_t>> stretches(const std::vector<double>& depth)
{
    std::vector<std::pair<std::size_t, std::size_t>> all;
    for (std::size_t i = 0; i < depth.size(); ++i) {
        if (!(depth[i] > 0)) continue;
        const std::size_t first = i > kFaded ? i - kFaded : 0, end = std::min(i + kFaded + 1, depth.size());
        if (!all.empty() && all.back().second >= first)
            all.back().second = end;
        else
            all.emplace_back(first, end);
    }
    return all;
}

} // namespace

void tilt_smoothly(const Trials& trials, const std::vector<double>& depth, const AvoidOptions& options, Led& led)
{
    const auto all = stretches(depth);
    tbb::parallel_for(std::size_t{0}, all.size(), [&](std::size_t k) {
        const auto [first, end] = all[k];
        Stretch stretch(trials, depth, options, first, end);
        stretch.search();
        for (std::size_t i = first; i < end; ++i) {
            const auto column = static_cast<Index>(i);
            const PoseChange change{stretch.tilt(i), 0};
            if (change == PoseChange()) continue;
            const CellJoints q = trials.joints(column, change, trials.near(column));
            if (q.hasNaN()) continue;
            led.changes[i] = change;
            led.joints.col(column) = q;
        }
    });
}

} // namespace fettle
