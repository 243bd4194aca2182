#include "machining/limits.h"

#include "core/error.h"
#include "core/text.h"

namespace fettle::machining {

void require_within(const std::string& name, double value, const core::Range& range)
{
    if (!range.contains(value))
        throw core::InputError(name + " must be " + range.text() + ", not " + core::to_text(value));
}

} // namespace fettle::machining
