#pragma once

#include "draw/html.h"

namespace fettle::report {

/// Style sheet of a report page, for screen and A4 print.
draw::Html style_sheet();

} // namespace fettle::report
