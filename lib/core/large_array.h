#pragma once

#include <sys/mman.h>

#include <cstddef>
#include <cstdlib>
#include <new>
#include <utility>
#include <vector>

namespace fettle {

/// For arrays as large as meshes: on huge pages where the system has them, which are asked for once, and found faster,
/// than 512 small ones. Elements without a constructor of their own are not filled with zeros.
template <typename T>
struct LargeArrays {
    using value_type = T;

    LargeArrays() = default;
    template <typename U>
    LargeArrays(const LargeArrays<U>&)
    {
    }

    T* allocate(std::size_t count)
    {
        const std::size_t bytes = count * sizeof(T);
        const bool large = bytes >= 2 * kHugePage; // less than half of it is wasted on a page that is begun
        const std::size_t whole = large ? (bytes + kHugePage - 1) / kHugePage * kHugePage : bytes;
        void* const place = large ? std::aligned_alloc(kHugePage, whole) : std::malloc(bytes);
        if (place == nullptr) throw std::bad_alloc();
        if (large) madvise(place, whole, MADV_HUGEPAGE); // if it cannot be had, the small ones do
        return static_cast<T*>(place);
    }
    void deallocate(T* place, std::size_t) { std::free(place); }

    template <typename U, typename... Arguments>
    void construct(U* place, Arguments&&... arguments)
    {
        if constexpr (sizeof...(Arguments) == 0)
            ::new (static_cast<void*>(place)) U;
        else
            ::new (static_cast<void*>(place)) U(std::forward<Arguments>(arguments)...);
    }

    template <typename U>
    bool operator==(const LargeArrays<U>&) const
    {
        return true;
    }

  private:
    static_assert(alignof(T) <= alignof(std::max_align_t));
    static constexpr std::size_t kHugePage = std::size_t{1} << 21;
};

template <typename T>
using LargeArray = std::vector<T, LargeArrays<T>>;

} // namespace fettle
