#include "belt/belt_watch.h"

#include "core/error.h"
#include "core/text.h"

namespace fettle {

BeltWatch::BeltWatch(const std::string& path, double mm) : path_(path), mm_(mm), file_(path)
{
    file_ << "point,t,gouge,within,undercut,mean,rms,min\n" << std::flush;
    check();
}

void BeltWatch::write(const BeltRun& run)
{
    for (; lines_ < run.errors.size(); ++lines_) {
        const BeltError& error = run.errors[lines_];
        file_ << lines_ << ',' << to_short_text(run.trace[lines_].time) << ',' << error.gouge << ',' << error.within
              << ',' << error.undercut;
        for (const double length : {error.mean, error.rms, error.least}) file_ << ',' << to_short_text(length / mm_);
        file_ << '\n';
    }
    file_.flush();
    check();
}

void BeltWatch::check() const
{
    if (!file_) throw InputError(path_, "could not be written");
}

} // namespace fettle
