// The trace of a run that is to be taken up again. What was read is written and reads the same again.

#include "memory_file.h"
#include "strategy/trace_file.h"

#include <sstream>

using namespace fettle;

namespace {

std::string written(const std::vector<TraceRow>& rows, const Units& units)
{
    std::ostringstream out;
    write_pcd(out, to_cloud(rows), units, PcdEncoding::binary);
    return out.str();
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    static fuzz::MemoryFile memory;
    const std::string_view bytes = fuzz::text_of(data, size);
    for (const Units& units : {Units{}, Units{Units::Length::in, Units::Force::lbf}}) {
        std::vector<TraceRow> rows;
        if (!fuzz::is_read([&] { rows = read_trace(memory.with(bytes), units); })) continue;
        const std::string once = written(rows, units);
        fuzz::require(written(read_trace(memory.with(once), units), units) == once, "it reads the same again");
    }
    return 0;
}
