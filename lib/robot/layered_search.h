#pragma once

#include <algorithm>
#include <compare>
#include <cstddef>
#include <limits>
#include <ranges>
#include <vector>

namespace fettle::robot {

/// Viterbi's algorithm: the cheapest path through a sequence of layers, one state of each. Of equally cheap paths the
/// one with the lower index in the last layer where they differ.
class ViterbiSearch {
  public:
    /// Cost of a path: the number of violated constraints first, the length second.
    struct Cost {
        int violations = 0; ///< violated constraints
        double length = 0;

        auto operator<=>(const Cost&) const = default;
    };

    /// Adds a layer of `count` states, at least one.
    /// @param transition_cost  (from, to) -> Cost of going from a state of the previous layer to one of this layer; in
    /// the
    ///                         first layer of starting there (from is 0)
    template <class TransitionCost>
    void add(std::size_t count, const TransitionCost& transition_cost)
    {
        const std::size_t previous = layers_.empty() ? 0 : layers_.back(), end = states_.size();
        layers_.push_back(end);
        for (std::size_t to = 0; to < count; ++to) {
            State best{{std::numeric_limits<int>::max(), 0}, 0};
            if (end == 0) best = {transition_cost(std::size_t{0}, to), 0};
            for (std::size_t from = previous; from < end; ++from) {
                const Cost last = transition_cost(from - previous, to), &so_far = states_[from].cost;
                const Cost cost{so_far.violations + last.violations, so_far.length + last.length};
                if (cost < best.cost) best = {cost, from};
            }
            states_.push_back(best);
        }
    }

    /// Index in the last layer of the state where the cheapest path ends.
    std::size_t best_end() const
    {
        const auto first = states_.begin() + layers_.back();
        return std::min_element(first, states_.end(), [](const State& a, const State& b) { return a.cost < b.cost; }) -
               first;
    }

    /// The cheapest path: for each layer the index of its state.
    std::vector<std::size_t> path() const
    {
        std::vector<std::size_t> indices(layers_.size());
        if (layers_.empty()) return indices;
        std::size_t at = layers_.back() + best_end();
        for (std::size_t k = layers_.size(); k-- > 0; at = states_[at].from) indices[k] = at - layers_[k];
        return indices;
    }

  private:
    struct State {
        Cost cost;        ///< of the cheapest path to it
        std::size_t from; ///< the previous state on that path
    };
    std::vector<State> states_;
    std::vector<std::size_t> layers_; ///< first state of each layer
};

} // namespace fettle::robot
