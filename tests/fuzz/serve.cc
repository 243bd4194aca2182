// Commands to a driver of the simulated gantry, line by line; it answers each in one line.

#include "gantry/serve.h"
#include "core/descriptor.h"
#include "gantry/quasi_static.h"
#include "memory_file.h"

#include <algorithm>
#include <fcntl.h>

using namespace fettle;

namespace {

job::Job small_job()
{
    job::Job job;
    job.wheel = {.radius = 10, .width = 6, .min_radius = 5};
    job.safe_height = 30;
    return job;
}

removal::HeightField plate()
{
    const Eigen::AlignedBox2d box(Eigen::Vector2d(-8, -8), Eigen::Vector2d(8, 8));
    removal::HeightField field = removal::empty_height_field(box, {0, 0}, 0, 1);
    field.z.setConstant(10);
    return field;
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    static const job::Job job = small_job();
    static const removal::HeightField stock = plate();
    static fuzz::MemoryFile input, output;
    const std::string_view lines = fuzz::text_of(data, size);
    gantry::QuasiStaticGantry gantry(stock, job);
    const core::FileDescriptor in(::open(input.with(lines).c_str(), O_RDONLY)),
        out(::open(output.with("").c_str(), O_WRONLY));
    gantry::serve(gantry, gantry.limits(), job, in, out);
    fuzz::require(gantry.stock().z.isFinite().all(), "the stock stays one");
    fuzz::require(gantry.status().commanded.allFinite(), "the machine stays somewhere");
    return 0;
}
