#pragma once

#include "core/descriptor.h"
#include "gantry/gantry.h"
#include "gantry/protocol.h"
#include "job/job.h"

namespace fettle {

/// The driver's side of docs/driver.md: does what the lines of `in` ask for and answers on `out`, until `quit`, `stop`
/// or the end of `in`. A fault of the machine is answered by an error.
/// @throws InputError if an answer cannot be written, or for a line without an end
void serve(Gantry& gantry, const protocol::Limits& limits, const Job& job, const Descriptor& in, const Descriptor& out);

} // namespace fettle
