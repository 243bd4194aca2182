#include "cloud/ply_body.h"

#include "core/error.h"

namespace fettle {

void AsciiPlyBody::check_room(const PlyHeader::Element& element) const
{
    const std::size_t shortest_line = 2 * element.properties.size(); // "0 0 0\n"
    if (element.count > (left_ - lines_.offset() + 1) / shortest_line)
        refuse("element " + element.name + " " + std::to_string(element.count) + ": only " +
               std::to_string(left_ - lines_.offset()) + " bytes left");
}

void AsciiPlyBody::begin_item(const std::string& element, std::size_t index)
{
    do
        if (!lines_.next()) refuse("element " + element + ": only " + std::to_string(index) + " lines");
    while (lines_.line().find_first_not_of(" \t") == std::string_view::npos);
    rest_ = lines_.line();
}

void AsciiPlyBody::end_item()
{
    const std::string_view word = next_word(rest_);
    if (!word.empty()) refuse("more values than properties: " + in_quotes(word));
}

void AsciiPlyBody::end()
{
    while (lines_.next())
        if (lines_.line().find_first_not_of(" \t") != std::string_view::npos)
            refuse("text after the last element: " + in_quotes(lines_.line()));
}

void AsciiPlyBody::check_list_room(std::size_t length) const
{
    if (length > rest_.size()) refuse("a list of " + std::to_string(length) + " on a line too short for it");
}

void AsciiPlyBody::refuse(const std::string& problem) const
{
    throw InputError(source_, lines_.place() + ": " + problem);
}

void BinaryPlyBody::check_room(const PlyHeader::Element& element) const
{
    std::size_t least = 0;
    for (const PlyHeader::Property& property : element.properties)
        least += static_cast<std::size_t>(property.list ? property.count_size : property.size);
    if (element.count > body_.size() / least)
        throw InputError(source_, "element " + element.name + " " + std::to_string(element.count) + ": only " +
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
        throw InputError(source_, std::to_string(body_.size()) + " bytes after the last element");
}

void BinaryPlyBody::check_list_room(std::size_t length) const
{
    if (length > body_.size()) refuse("a list of " + std::to_string(length) + ", the file ends");
}

void BinaryPlyBody::refuse(const std::string& problem) const
{
    throw InputError(source_, *element_ + " " + std::to_string(index_) + ": " + problem);
}

} // namespace fettle
