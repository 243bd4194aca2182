#include "core/range.h"

#include "core/text.h"

namespace fettle::core {

bool Range::contains(double value) const
{
    return (includes_min ? value >= min : value > min) && (includes_max ? value <= max : value < max);
}

std::string Range::text() const
{
    const bool bounded_below = min > std::numeric_limits<double>::lowest();
    const bool bounded_above = max < std::numeric_limits<double>::max();
    if (!bounded_below && !bounded_above) return "finite";
    if (!bounded_above)
        return min == 0 && !includes_min ? "positive" : (includes_min ? "at least " : "above ") + to_text(min);
    if (!bounded_below) return (includes_max ? "at most " : "below ") + to_text(max);
    return std::string("in ") + (includes_min ? "[" : "(") + to_text(min) + ", " + to_text(max) +
           (includes_max ? "]" : ")");
}

} // namespace fettle::core
