#include "belt/belt_watch.h"

#include "core/error.h"
#include "core/text.h"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <sstream>

namespace fettle::belt {

BeltErrorLog::BeltErrorLog(const std::string& path, double mm_per_unit)
    : path_(path), mm_per_unit_(mm_per_unit),
      file_(::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666))
{
    append("point,t,gouge,within,undercut,mean,rms,min\n");
}

void BeltErrorLog::write(const BeltRun& run)
{
    std::ostringstream out;
    for (; lines_written_ < run.errors.size(); ++lines_written_) {
        const BeltError& error = run.errors[lines_written_];
        out << lines_written_ << ',' << core::to_short_text(run.trace[lines_written_].time) << ',' << error.gouge << ','
            << error.within << ',' << error.undercut;
        for (const double length : {error.mean, error.rms, error.min})
            out << ',' << core::to_short_text(length / mm_per_unit_);
        out << '\n';
    }
    append(out.str());
}

void BeltErrorLog::append(const std::string& lines)
{
    if (!file_.is_open() || !core::write_all(file_, lines))
        throw core::InputError(path_, std::string("cannot write: ") + std::strerror(errno));
}

} // namespace fettle::belt
