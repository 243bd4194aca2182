#pragma once

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

namespace fettle::geometry {

/// Disjoint sets of the elements 0 to n - 1 (Tarjan, Efficiency of a good but not linear set union algorithm, 1975),
/// with path compression. Each element also has a parity, even or odd relative to the root of its set.
class UnionFind {
  public:
    struct Root {
        std::uint32_t element; ///< stands for the set
        bool odd;              ///< parity of the element sought relative to it
    };

    /// n sets of one element each. @param elements  n, less than 2^32
    explicit UnionFind(std::size_t elements) : parent_(elements), odd_(elements, false)
    {
        std::iota(parent_.begin(), parent_.end(), 0u);
    }

    Root find(std::uint32_t element)
    {
        std::uint32_t root = element;
        bool odd = false;
        for (; parent_[root] != root; root = parent_[root]) odd = odd != odd_[root];
        for (bool parity = odd; parent_[element] != root && element != root;) { // path compression
            const std::uint32_t next = parent_[element];
            const bool step = odd_[element];
            parent_[element] = root;
            odd_[element] = parity;
            parity = parity != step;
            element = next;
        }
        return {root, odd};
    }
    std::uint32_t root(std::uint32_t element) { return find(element).element; }

    /// Unites the sets of two elements. The lower root becomes the root of both, so that a set's root is its lowest
    /// element. @param odd  parity of the two relative to each other; ignored if they are in one set already
    void join(std::uint32_t one, std::uint32_t other, bool odd = false)
    {
        Root a = find(one), b = find(other);
        if (b.element < a.element) std::swap(a, b);
        attach(b, a, odd);
    }

    /// Unites the sets of two elements; the root of `upper` becomes that of both.
    void join_under(std::uint32_t element, std::uint32_t upper) { attach(find(element), find(upper), false); }

  private:
    void attach(const Root& lower, const Root& upper, bool odd)
    {
        if (lower.element == upper.element) return;
        parent_[lower.element] = upper.element;
        odd_[lower.element] = (lower.odd != upper.odd) != odd;
    }

    std::vector<std::uint32_t> parent_;
    std::vector<bool> odd_; ///< parity of an element relative to its parent
};

} // namespace fettle::geometry
