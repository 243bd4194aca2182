#include "machining/number_list.h"

#include "core/error.h"
#include "core/text.h"

#include <algorithm>
#include <cmath>

namespace fettle {

std::vector<double> numbers_of(std::string_view list, const std::vector<std::string>& names)
{
    std::vector<double> values;
    for (std::size_t k = 0; k < names.size(); ++k) {
        const std::size_t comma = std::min(list.find(','), list.size());
        const bool last = k + 1 == names.size();
        const auto value = parse_number(list.substr(0, comma));
        if (!value || !std::isfinite(*value) || last != (comma == list.size()))
            throw InputError("expected a number for " + names[k] + (last ? " at the end" : " and a comma") + ", got '" +
                             std::string(list) + "'");
        values.push_back(*value);
        list.remove_prefix(std::min(comma + 1, list.size()));
    }
    return values;
}

} // namespace fettle
