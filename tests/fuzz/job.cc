// Jobs and plans, which carry one. What was read is written and reads the same again.

#include "fuzz.h"
#include "plan/plan.h"
#include "same_document.h"
#include "json/document.h"

using namespace fettle;

namespace {

template <typename Parse>
void check(std::string_view text, const Parse& parse)
{
    std::string written;
    if (!fuzz::is_read([&] { written = to_json(parse(json::Reader::parse(text, "file"))).text(); })) return;
    const std::string again = to_json(parse(json::Reader::parse(written, "written"))).text();
    fuzz::require_same(again, written);
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    const std::string_view text = fuzz::text_of(data, size);
    check(text, [](json::Reader reader) { return job::parse_job(std::move(reader)); });
    check(text, [](json::Reader reader) { return plan::parse_plan(std::move(reader)); });
    return 0;
}
