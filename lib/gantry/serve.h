#pragma once

#include "core/descriptor.h"
#include "gantry/gantry.h"
#include "gantry/protocol.h"
#include "job/job.h"

namespace fettle {

/// The driver's side of docs/driver.md: does what the lines of `in` ask for and answers on `out`, until `quit`, `stop`
/// the end of `in`, or until nobody is there to hear an answer: the head has then gone up. A fault of the machine is
/// answered by an error. SIGPIPE is ignored from then on.
/// @throws InputError if an answer cannot be written for another reason, or for a line without an end
void serve(Gantry& gantry, const protocol::Limits& limits, const Job& job, const Descriptor& in, const Descriptor& out);

} // namespace fettle
