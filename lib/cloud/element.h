#pragma once

#include "core/lines.h"
#include "core/text.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <string_view>
#include <type_traits>

namespace fettle::cloud {

/// True if PCD has elements of this type ('F', 'I', 'U') and size in bytes.
constexpr bool is_element_type(char type, std::size_t size)
{
    if (type == 'F') return size == 4 || size == 8;
    return (type == 'I' || type == 'U') && (size == 1 || size == 2 || size == 4 || size == 8);
}

/// Calls `use` with a 0 of the C++ type that a PCD type and size denote: visit_element('F', 4, [](auto zero) { … }).
/// is_element_type() must hold.
template <typename Use>
decltype(auto) visit_element(char type, int size, Use&& use)
{
    if (type == 'F') return size == 4 ? use(float{}) : use(double{});
    if (type == 'I') {
        if (size == 1) return use(std::int8_t{});
        if (size == 2) return use(std::int16_t{});
        return size == 4 ? use(std::int32_t{}) : use(std::int64_t{});
    }
    if (size == 1) return use(std::uint8_t{});
    if (size == 2) return use(std::uint16_t{});
    return size == 4 ? use(std::uint32_t{}) : use(std::uint64_t{});
}

/// Loads an element from memory that need not be aligned; store() is its inverse.
template <typename T>
T load(const void* bytes)
{
    T value;
    std::memcpy(&value, bytes, sizeof value);
    return value;
}

template <typename T>
void store(void* bytes, T value)
{
    std::memcpy(bytes, &value, sizeof value);
}

/// Parses a number into the bytes of an element. @return  false if it is not a number or does not fit the type
template <typename T>
bool parse_element(std::string_view word, void* to)
{
    if constexpr (std::is_floating_point_v<T>) {
        const std::optional<double> value = core::parse_number(word);
        if (!value) return false;
        if (std::isfinite(*value) && std::abs(*value) > std::numeric_limits<T>::max()) return false;
        store(to, static_cast<T>(*value));
        return true;
    } else {
        const std::optional<T> value = core::parse_integer<T>(word);
        if (!value) return false;
        store(to, *value);
        return true;
    }
}

/// Name of a type in messages: "F4", "U1".
inline std::string element_name(char type, int size) { return type + std::to_string(size); }

} // namespace fettle::cloud
