#pragma once

#include "report/html.h"

namespace fettle {

/// The style sheet of a page, for the screen and for A4.
Html style_sheet();

} // namespace fettle
