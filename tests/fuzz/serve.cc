// What a driver of the simulated gantry is told, line by line; it answers each in one line.

#include "gantry/serve.h"
#include "core/descriptor.h"
#include "gantry/quasi_static.h"
#include "memory_file.h"

#include <algorithm>
#include <fcntl.h>

using namespace fettle;

namespace {

Job small_job()
{
    Job job;
    job.wheel = {.radius = 10, .width = 6, .min_radius = 5};
    job.safe_height = 30;
    return job;
}

HeightField plate()
{
    Eigen::Matrix2d box;
    box << -8, 8, -8, 8;
    HeightField field = empty_height_field(box, {0, 0}, 0, 1);
    field.z.setConstant(10);
    return field;
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    static const Job job = small_job();
    static const HeightField stock = plate();
    static fuzz::MemoryFile told, answered;
    const std::string_view lines = fuzz::text_of(data, size);
    QuasiStaticGantry gantry(stock, job);
    const Descriptor in(::open(told.with(lines).c_str(), O_RDONLY)), out(::open(answered.with("").c_str(), O_WRONLY));
    serve(gantry, gantry.limits(), job, in, out);
    fuzz::require(gantry.stock().z.isFinite().all(), "the stock stays one");
    fuzz::require(gantry.status().commanded.allFinite(), "the machine stays somewhere");
    return 0;
}
