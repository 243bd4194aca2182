#include "robot/avoid_tilts.h"

#include "robot/layered_search.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace fettle::robot {

namespace {

using Eigen::Vector2d;

// Poses over which a tilt decays by 1/e: the largest changes by one to two degrees from pose to pose.
constexpr double kRampPoses = 32;
// Poses after which a tilt has decayed to 2 %. Farther from collisions the path is not changed.
constexpr std::size_t kDecayPoses = std::size_t(4 * kRampPoses);

// The first search: one pose of this many, and tilts on a grid with this spacing, rad.
constexpr std::size_t kFirstStep = 16;
constexpr double kFirstSpacing = std::numbers::pi / 24;
// Each refinement has the tilts within this many grid steps of those found before.
constexpr int kRefinementSteps = 2;
// The last spacing, rad: finer steps are below the repeatability of robots.
constexpr double kLastSpacing = std::numbers::pi / 720;

enum class Status : std::uint8_t { unknown, clear, collides };

// A pose of the search with its candidate tilts.
struct Layer {
    std::size_t pose = 0;
    std::vector<Vector2d> tilts;
    std::vector<Status> status; ///< by tilt
};

// A section of the path that is searched on its own.
class Section {
  public:
    Section(const ChangeChecker& trials, const std::vector<double>& depth, const AvoidOptions& options,
            std::size_t first, std::size_t end)
        : trials_(trials), depth_(depth), options_(options), first_(first), end_(end), tilts_(end - first),
          colliding_(end - first)
    {
        for (Vector2d& tilt : tilts_) tilt.setZero();
    }

    void search()
    {
        std::size_t step = kFirstStep;
        double spacing = kFirstSpacing;
        find_tilts(make_layers(step, [&](std::size_t) { return all_tilts(); }));
        while (step > 1 || spacing > kLastSpacing) {
            step = std::max<std::size_t>(1, step / 2);
            spacing /= 2;
            find_tilts(make_layers(step, [&](std::size_t pose) { return tilts_near(tilt(pose), spacing); }));
        }
    }

    const Vector2d& tilt(std::size_t pose) const { return tilts_[pose - first_]; }

  private:
    // All allowed tilts on a square grid.
    std::vector<Vector2d> all_tilts() const
    {
        std::vector<Vector2d> tilts;
        const int max = int(std::floor(options_.max_tilt / kFirstSpacing * (1 + 1e-9)));
        for (int x = -max; x <= max; ++x)
            for (int y = -max; y <= max; ++y)
                if (x * x + y * y <= max * max) tilts.push_back(kFirstSpacing * Vector2d(x, y));
        return tilts;
    }

    std::vector<Vector2d> tilts_near(const Vector2d& centre, double spacing) const
    {
        std::vector<Vector2d> tilts;
        for (int x = -kRefinementSteps; x <= kRefinementSteps; ++x)
            for (int y = -kRefinementSteps; y <= kRefinementSteps; ++y) {
                const Vector2d tilt = centre + spacing * Vector2d(x, y);
                if (tilt.norm() <= options_.max_tilt * (1 + 1e-9)) tilts.push_back(tilt);
            }
        if (centre.norm() < 2 * kRefinementSteps * spacing) tilts.push_back(Vector2d::Zero()); // the grid may miss it
        return tilts;
    }

    // At its ends within the path a section must join the unchanged path.
    bool is_fixed(std::size_t pose) const
    {
        return (pose == first_ && first_ > 0) || (pose + 1 == end_ && end_ < depth_.size());
    }

    // A layer for the deepest of each `step` poses, and for both ends. @param tilts  (pose) -> its candidates
    template <class Tilts>
    std::vector<Layer> make_layers(std::size_t step, const Tilts& tilts) const
    {
        std::vector<Layer> layers;
        const auto add = [&](std::size_t pose) {
            if (!layers.empty() && layers.back().pose == pose) return;
            Layer layer{pose, is_fixed(pose) ? std::vector<Vector2d>{Vector2d::Zero()} : tilts(pose), {}};
            layer.status.assign(layer.tilts.size(), Status::unknown);
            mark_colliding(layer);
            layers.push_back(std::move(layer));
        };
        add(first_);
        for (std::size_t from = first_; from < end_; from += step)
            add(std::max_element(depth_.begin() + from, depth_.begin() + std::min(from + step, end_)) - depth_.begin());
        add(end_ - 1);
        return layers;
    }

    // Marks the candidates that are known to collide.
    void mark_colliding(Layer& layer) const
    {
        for (std::size_t i = 0; i < layer.tilts.size(); ++i)
            if (layer.status[i] == Status::unknown && colliding_[layer.pose - first_].contains({layer.tilts[i], 0}))
                layer.status[i] = Status::collides;
    }

    // The optimal tilts: for each layer the index of one. A tilt with unknown status counts as clear.
    static std::vector<std::size_t> optimal_tilts(const std::vector<Layer>& layers)
    {
        ViterbiSearch search;
        for (std::size_t k = 0; k < layers.size(); ++k) {
            const Layer& here = layers[k];
            // The number of poses that the layer stands for.
            const double weight =
                double(layers[std::min(k + 1, layers.size() - 1)].pose - layers[k > 0 ? k - 1 : 0].pose) / 2;
            search.add(here.tilts.size(), [&](std::size_t from, std::size_t to) -> ViterbiSearch::Cost {
                const double tilt_cost = weight * here.tilts[to].squaredNorm() / (kRampPoses * kRampPoses);
                const int collides = here.status[to] == Status::collides ? 1 : 0;
                if (k == 0) return {collides, tilt_cost};
                const double poses = double(here.pose - layers[k - 1].pose);
                return {collides, tilt_cost + (here.tilts[to] - layers[k - 1].tilts[from]).squaredNorm() / poses};
            });
        }
        return search.path();
    }

    // Sets the optimal collision-free tilts of the layers, and interpolates linearly between them.
    void find_tilts(std::vector<Layer> layers)
    {
        std::vector<std::size_t> path;
        for (bool changed = true; changed;) {
            path = optimal_tilts(layers);
            changed = false;
            for (std::size_t k = 0; k < layers.size(); ++k)
                if (layers[k].status[path[k]] == Status::unknown && check_collides(layers[k], path[k])) changed = true;
        }
        for (std::size_t k = 0; k + 1 < layers.size(); ++k) {
            const Vector2d &a = layers[k].tilts[path[k]], &b = layers[k + 1].tilts[path[k + 1]];
            const std::size_t from = layers[k].pose, n = layers[k + 1].pose - from;
            for (std::size_t i = 0; i <= n; ++i) tilts_[from - first_ + i] = a + (b - a) * (double(i) / double(n));
        }
    }

    // Checks a candidate. If it collides, others that must collide, too, are marked. @return  does it collide?
    bool check_collides(Layer& layer, std::size_t candidate)
    {
        Status& status = layer.status[candidate];
        const bool is_unchanged = layer.tilts[candidate].isZero(0); // the unchanged pose has been checked before
        if (is_unchanged) {
            status = depth_[layer.pose] > 0 ? Status::collides : Status::clear;
            if (status == Status::clear) return false;
        }
        const CellJoints q = trials_.find_clear_joints(
            layer.pose, {layer.tilts[candidate], 0}, trials_.seed_joints(layer.pose), colliding_[layer.pose - first_]);
        if (!is_unchanged) status = q.hasNaN() ? Status::collides : Status::clear;
        if (status == Status::clear) return false;
        mark_colliding(layer);
        return true;
    }

    const ChangeChecker& trials_;
    const std::vector<double>& depth_;
    const AvoidOptions& options_;
    std::size_t first_, end_;
    std::vector<Vector2d> tilts_;             ///< by pose: the best so far
    std::vector<CollidingChanges> colliding_; ///< by pose: the changes known to collide
};

// The sections of the path around collisions, as (first pose, end), with so much distance between them that their tilts
// do not interact.
std::vector<std::pair<std::size_t, std::size_t>> find_sections(const std::vector<double>& depth)
{
    std::vector<std::pair<std::size_t, std::size_t>> sections;
    for (std::size_t i = 0; i < depth.size(); ++i) {
        if (!(depth[i] > 0)) continue;
        const std::size_t first = i > kDecayPoses ? i - kDecayPoses : 0,
                          end = std::min(i + kDecayPoses + 1, depth.size());
        if (!sections.empty() && sections.back().second >= first)
            sections.back().second = end;
        else
            sections.emplace_back(first, end);
    }
    return sections;
}

} // namespace

void tilt_smoothly(const ChangeChecker& trials, const std::vector<double>& depth, const AvoidOptions& options,
                   ChangedPath& path)
{
    const auto sections = find_sections(depth);
    tbb::parallel_for(std::size_t{0}, sections.size(), [&](std::size_t k) {
        const auto [first, end] = sections[k];
        Section section(trials, depth, options, first, end);
        section.search();
        for (std::size_t i = first; i < end; ++i) {
            const PoseChange change{section.tilt(i), 0};
            if (change == PoseChange()) continue;
            const CellJoints q = trials.nearest_joints(i, change, trials.seed_joints(i));
            if (q.hasNaN()) continue;
            path.changes[i] = change;
            path.joints.col(i) = q;
        }
    });
}

} // namespace fettle::robot
