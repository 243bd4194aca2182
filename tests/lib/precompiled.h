// As lib/precompiled.h, for the tests.
#include "../../lib/precompiled.h"
#include <gtest/gtest.h>
