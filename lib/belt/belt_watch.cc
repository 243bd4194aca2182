#include "belt/belt_watch.h"

#include "core/error.h"
#include "core/text.h"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <sstream>

namespace fettle {

BeltWatch::BeltWatch(const std::string& path, double mm)
    : path_(path), mm_(mm), file_(::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666))
{
    append("point,t,gouge,within,undercut,mean,rms,min\n");
}

void BeltWatch::write(const BeltRun& run)
{
    std::ostringstream out;
    for (; lines_ < run.errors.size(); ++lines_) {
        const BeltError& error = run.errors[lines_];
        out << lines_ << ',' << to_short_text(run.trace[lines_].time) << ',' << error.gouge << ',' << error.within
            << ',' << error.undercut;
        for (const double length : {error.mean, error.rms, error.least}) out << ',' << to_short_text(length / mm_);
        out << '\n';
    }
    append(out.str());
}

void BeltWatch::append(const std::string& lines)
{
    if (!file_.is_open() || !write_all(file_, lines))
        throw InputError(path_, std::string("cannot write: ") + std::strerror(errno));
}

} // namespace fettle
