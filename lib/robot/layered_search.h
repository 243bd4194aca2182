#pragma once

#include <compare>
#include <cstddef>
#include <limits>
#include <vector>

namespace fettle {

/// The shortest way through layers of stations, one of each (Viterbi). Of equally long ones that with the lower
/// numbers, from the end.
class LayeredSearch {
  public:
    /// Fewer faults are shorter, whatever the length.
    struct Length {
        int faults = 0;
        double length = 0;

        auto operator<=>(const Length&) const = default;
    };

    /// Adds a layer of `count` stations, at least one.
    /// @param way  (from, to) -> Length of the way from a station of the layer before, or, in the first layer, of the
    /// way to begin with (from is 0)
    template <class Way>
    void add(std::size_t count, const Way& way)
    {
        const std::size_t before = layers_.empty() ? 0 : layers_.back(), end = stations_.size();
        layers_.push_back(end);
        for (std::size_t to = 0; to < count; ++to) {
            Station best{{std::numeric_limits<int>::max(), 0}, 0};
            if (end == 0) best = {way(std::size_t{0}, to), 0};
            for (std::size_t from = before; from < end; ++from) {
                const Length last = way(from - before, to), &so_far = stations_[from].length;
                const Length length{so_far.faults + last.faults, so_far.length + last.length};
                if (length < best.length) best = {length, from};
            }
            stations_.push_back(best);
        }
    }

    bool empty() const { return layers_.empty(); }
    std::size_t layers() const { return layers_.size(); }

    /// Number in the last layer of the station where the shortest way ends.
    std::size_t best() const
    {
        std::size_t best = layers_.back();
        for (std::size_t i = best; i < stations_.size(); ++i)
            if (stations_[i].length < stations_[best].length) best = i;
        return best - layers_.back();
    }

    /// The stations of the shortest way: of each layer the number.
    std::vector<std::size_t> path() const
    {
        std::vector<std::size_t> numbers(layers_.size());
        if (empty()) return numbers;
        std::size_t at = layers_.back() + best();
        for (std::size_t k = layers_.size(); k-- > 0; at = stations_[at].from) numbers[k] = at - layers_[k];
        return numbers;
    }

  private:
    struct Station {
        Length length;    ///< of the shortest way to it
        std::size_t from; ///< station before
    };
    std::vector<Station> stations_;
    std::vector<std::size_t> layers_; ///< first station of each
};

} // namespace fettle
