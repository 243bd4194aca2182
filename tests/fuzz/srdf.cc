// Pairs of links that may touch, as SRDF: what is allowed are pairs of bodies that there are.

#include "robot/srdf.h"
#include "fuzz.h"
#include "memory_file.h"

using namespace fettle;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    static fuzz::MemoryFile file;
    const std::vector<std::string> links = {"base_link", "link_1", "link_1", "tool0"};
    robot::Robot robot;
    const std::string& path = file.with(fuzz::text_of(data, size));
    if (!fuzz::is_read([&] { robot::read_srdf(path, links, robot); })) return 0;
    for (const auto& [a, b] : robot.allowed) fuzz::require(a < b && b < links.size(), "a pair of bodies");
    return 0;
}
