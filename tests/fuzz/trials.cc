// Rows of trials, and laws that were learnt: what is read is learned from or refused, and a record is written and read
// the same again.

#include "calibrate/law_record.h"
#include "calibrate/trials_csv.h"
#include "fuzz.h"
#include "json/document.h"

using namespace fettle;

namespace {

/// So many passes are learned from: each takes the models' time.
constexpr std::size_t kMaxPasses = 20;

void learn_from(const calibrate::LawRecord& record)
{
    if (record.passes.size() <= kMaxPasses) calibrate::learn(record);
    const std::string written = calibrate::to_json(record).text();
    const calibrate::LawRecord again = calibrate::read_record(json::Reader::parse(written, "written"));
    fuzz::require(calibrate::to_json(again).text() == written, "a record that was written is read the same");
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    const std::string_view text = fuzz::text_of(data, size);
    fuzz::is_read([&] {
        if (text.starts_with('{')) {
            learn_from(calibrate::read_record(json::Reader::parse(text, "file").object("learnt").object("record")));
        } else {
            const auto trials = calibrate::read_trials(text, "file").exact;
            calibrate::LawRecord record;
            record.pass_work = calibrate::typical_pass_work(trials.front());
            record.passes = trials;
            learn_from(record);
        }
    });
    return 0;
}
