// What most files of the library include, read once a build (Makefile, PRECOMPILED). A file includes what it uses all
// the same: this header is never named by one.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <filesystem>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <numbers>
#include <numeric>
#include <optional>
#include <random>
#include <set>
#include <span>
#include <sstream>
#include <string>
#include <string_view>
#include <tbb/parallel_for.h>
#include <utility>
#include <variant>
#include <vector>
