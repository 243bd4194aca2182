#include "core/range.h"

#include "core/text.h"

namespace fettle {

bool Range::contains(double value) const
{
    return (least_itself ? value >= least : value > least) && (most_itself ? value <= most : value < most);
}

std::string Range::text() const
{
    const bool bounded_below = least > std::numeric_limits<double>::lowest();
    const bool bounded_above = most < std::numeric_limits<double>::max();
    if (!bounded_below && !bounded_above) return "finite";
    if (!bounded_above)
        return least == 0 && !least_itself ? "positive" : (least_itself ? "at least " : "above ") + to_text(least);
    if (!bounded_below) return (most_itself ? "at most " : "below ") + to_text(most);
    return std::string("in ") + (least_itself ? "[" : "(") + to_text(least) + ", " + to_text(most) +
           (most_itself ? "]" : ")");
}

} // namespace fettle
