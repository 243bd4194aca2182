#pragma once

#include "core/descriptor.h"
#include "gantry/gantry.h"
#include "gantry/protocol.h"
#include "job/job.h"

namespace fettle::gantry {

/// The driver's side of docs/driver.md: executes the commands on `in` and answers on `out`, until `quit`, `stop`, the
/// end of `in`, or until the reader of `out` has closed it; the head has then been raised. A fault of the machine is
/// answered by an error. SIGPIPE is ignored from then on.
/// @throws InputError if an answer cannot be written for another reason, or for a line without an end
void serve(Gantry& gantry, const protocol::Limits& limits, const job::Job& job, const core::FileDescriptor& in,
           const core::FileDescriptor& out);

} // namespace fettle::gantry
