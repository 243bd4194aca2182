#pragma once

#include <memory>
#include <new>
#include <vector>

namespace fettle::core {

/// Allocator of a vector whose elements are not set when it grows without a value for them.
template <typename T>
struct UninitializedAllocator : std::allocator<T> {
    template <typename U>
    void construct(U* element)
    {
        ::new (static_cast<void*>(element)) U;
    }
};

/// A vector for results that several threads fill in, or for a buffer that is seldom full: std::vector would first set
/// all of it to 0, by one thread, which of large memory takes as long as the work, as the pages are mapped then.
/// @tparam T  without initializers for its members
template <typename T>
using UninitializedVector = std::vector<T, UninitializedAllocator<T>>;

} // namespace fettle::core
