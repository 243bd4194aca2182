#pragma once

#include "cloud/element.h"
#include "cloud/ply_header.h"
#include "core/lines.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <string_view>

namespace fettle::cloud {

// Two classes with the same interface read the values of a PLY body in order of the header: check_room() is called
// before an element, begin_item() and end_item() around each of its items, and end() after the last element. All throw
// InputError with the line, or with the element and the index of the item. `source` must outlive them.

/// Reads an ascii body, in which an item is a line.
class AsciiPlyBody : core::FileLines {
  public:
    /// @param lines_before  number of header lines, for line numbers in messages
    AsciiPlyBody(std::string_view body, std::size_t lines_before, const std::string& source)
        : core::FileLines(body, source, lines_before)
    {
    }

    /// Checks that the body is long enough for the element even if all values and lists are as short as possible.
    void check_room(const PlyHeader::Element& element) const;
    void begin_item(const std::string& element, std::size_t index);
    void end_item();
    void end();

    template <typename T>
    T value(const PlyHeader::Property& property)
    {
        const std::string_view word = core::next_word(rest_);
        if (word.empty()) refuse("property " + property.name + " is missing");
        T number{};
        if (!parse_element<T>(word, &number))
            refuse("property " + property.name + ": " + core::in_quotes(word) + " is not a number of its type");
        return number;
    }

    void check_list_room(std::size_t length) const;
    using core::FileLines::refuse;

  private:
    std::string_view rest_; ///< of the line
};

/// Reads a binary body.
class BinaryPlyBody {
  public:
    /// @param swap  the byte order of the file is not that of the machine
    BinaryPlyBody(std::string_view body, bool swap, const std::string& source)
        : body_(body), swap_(swap), source_(source)
    {
    }

    void check_room(const PlyHeader::Element& element) const;
    void begin_item(const std::string& element, std::size_t index);
    void end_item() {}
    void end() const;

    template <typename T>
    T value(const PlyHeader::Property& property)
    {
        if (body_.size() < sizeof(T)) refuse("property " + property.name + ": the file ends");
        std::array<char, sizeof(T)> bytes;
        std::copy_n(body_.begin(), sizeof(T), bytes.begin());
        if (swap_) std::reverse(bytes.begin(), bytes.end());
        body_.remove_prefix(sizeof(T));
        return load<T>(bytes.data());
    }

    void check_list_room(std::size_t length) const;
    [[noreturn]] void refuse(const std::string& problem) const;

  private:
    std::string_view body_;
    bool swap_;
    const std::string* element_ = nullptr;
    std::size_t index_ = 0;
    const std::string& source_;
};

} // namespace fettle::cloud
