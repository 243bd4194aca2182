#pragma once

#include "cloud/element.h"
#include "cloud/ply_header.h"
#include "core/lines.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <string_view>

namespace fettle {

// The values of a PLY body one after the other, in order of the header; what reads them takes either of the two
// classes: check_room() before an element, begin_item() and end_item() around each of its items, end() after the last.
// All throw InputError with the line, or with the item of the element. `source` must outlive them.

/// One item a line.
class AsciiPlyBody {
  public:
    /// @param lines_before  of the header, for messages
    AsciiPlyBody(std::string_view body, std::size_t lines_before, const std::string& source)
        : lines_(body, lines_before), left_(body.size()), source_(source)
    {
    }

    /// Are there bytes enough for the element, however short its values and lists?
    void check_room(const PlyHeader::Element& element) const;
    void begin_item(const std::string& element, std::size_t index);
    void end_item();
    void end();

    template <typename T>
    T value(const PlyHeader::Property& property)
    {
        const std::string_view word = next_word(rest_);
        if (word.empty()) refuse("property " + property.name + " is missing");
        T number{};
        if (!parse_element<T>(word, &number))
            refuse("property " + property.name + ": " + in_quotes(word) + " is no number of its type");
        return number;
    }

    void check_list_room(std::size_t length) const;
    [[noreturn]] void refuse(const std::string& problem) const;

  private:
    Lines lines_;
    std::size_t left_;
    std::string_view rest_;
    const std::string& source_;
};

/// Without gaps, little or big endian.
class BinaryPlyBody {
  public:
    /// @param swap  are the bytes of a value the other way round than in memory?
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

} // namespace fettle
