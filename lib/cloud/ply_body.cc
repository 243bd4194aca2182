#include "cloud/ply_body.h"

#include "core/error.h"

namespace fettle::cloud {

void AsciiPlyBody::check_room(const PlyHeader::Element& element) const
{
    const std::size_t min_line_bytes = 2 * element.properties.size(); // "0 0 0\n"
    if (element.count > (text_.size() - offset() + 1) / min_line_bytes)
        refuse("element " + element.name + " " + std::to_string(element.count) + ": only " +
               std::to_string(text_.size() - offset()) + " bytes left");
}

void AsciiPlyBody::begin_item(const std::string& element, std::size_t index)
{
    do
        if (!next()) refuse("element " + element + ": only " + std::to_string(index) + " lines");
    while (core::is_blank_line(line()));
    rest_ = line();
}

void AsciiPlyBody::end_item()
{
    const std::string_view word = core::next_word(rest_);
    if (!word.empty()) refuse("more values than properties: " + core::in_quotes(word));
}

void AsciiPlyBody::end()
{
    while (next())
        if (!core::is_blank_line(line())) refuse("text after the last element: " + core::in_quotes(line()));
}

void AsciiPlyBody::check_list_room(std::size_t length) const
{
    if (length > rest_.size()) refuse("a list of " + std::to_string(length) + " on a line too short for it");
}

void BinaryPlyBody::check_room(const PlyHeader::Element& element) const
{
    std::size_t min_bytes = 0;
    for (const PlyHeader::Property& property : element.properties)
        min_bytes += property.list ? property.count_size : property.size;
    if (element.count > body_.size() / min_bytes)
        throw core::InputError(source_, "element " + element.name + " " + std::to_string(element.count) + ": only " +
                                            std::to_string(body_.size()) + " bytes left");
}

void BinaryPlyBody::begin_item(const std::string& element, std::size_t index)
{
    element_ = &element;
    index_ = index;
}

void BinaryPlyBody::end() const
{
    if (body_.find_first_not_of(" \t\r\n") != std::string_view::npos)
        throw core::InputError(source_, std::to_string(body_.size()) + " bytes after the last element");
}

void BinaryPlyBody::check_list_room(std::size_t length) const
{
    if (length > body_.size()) refuse("a list of " + std::to_string(length) + ", the file ends");
}

void BinaryPlyBody::refuse(const std::string& problem) const
{
    throw core::InputError(source_, *element_ + " " + std::to_string(index_) + ": " + problem);
}

} // namespace fettle::cloud
