// The trace of a run that is to be taken up again. What was read is written and reads the same again.

#include "memory_file.h"
#include "strategy/trace_file.h"

#include <sstream>

using namespace fettle;

namespace {

std::string written(const std::vector<strategy::TraceRow>& rows, const units::Units& units)
{
    std::ostringstream out;
    cloud::write_pcd(out, strategy::to_cloud(rows), units, cloud::PcdEncoding::binary);
    return out.str();
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    static fuzz::MemoryFile memory;
    const std::string_view bytes = fuzz::text_of(data, size);
    for (const units::Units& units :
         {units::Units{}, units::Units{units::Units::Length::in, units::Units::Force::lbf}}) {
        std::vector<strategy::TraceRow> rows;
        if (!fuzz::is_read([&] { rows = strategy::read_trace(memory.with(bytes), units); })) continue;
        const std::string once = written(rows, units);
        fuzz::require(written(strategy::read_trace(memory.with(once), units), units) == once,
                      "it reads the same again");
    }
    return 0;
}
