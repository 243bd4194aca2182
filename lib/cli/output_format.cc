#include "cli/output_format.h"

#include "core/error.h"
#include "core/text.h"

#include <algorithm>
#include <cctype>

namespace fettle::cli {
namespace {

bool is_letter(unsigned char c) { return std::isalpha(c) != 0; }
bool is_letter_or_digit(unsigned char c) { return std::isalnum(c) != 0; }

} // namespace

std::string suffix_of(const std::string& path)
{
    std::string name = path.substr(path.find_last_of('/') + 1);
    const std::string unfinished = ".part";
    if (name.ends_with(unfinished)) name.resize(name.size() - unfinished.size());
    const std::size_t dot = name.rfind('.');
    if (dot == std::string::npos || dot == 0 || dot + 1 == name.size()) return "";
    std::string suffix = name.substr(dot + 1);
    if (!is_letter(static_cast<unsigned char>(suffix.front())) || !std::ranges::all_of(suffix, is_letter_or_digit))
        return "";
    std::ranges::transform(suffix, suffix.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return suffix;
}

std::string format_of_output(const std::string& path, const std::vector<std::string>& formats)
{
    const std::string suffix = path.starts_with("/dev/") ? "" : suffix_of(path);
    if (suffix.empty() || std::ranges::find(formats, suffix) != formats.end()) return suffix;
    throw core::InputError(path, "'." + suffix + "' is no format of this output: ." + core::join(formats, ", ."));
}

} // namespace fettle::cli
