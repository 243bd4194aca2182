#include "core/error.h"
#include "fit/bspline.h"
#include "fit/bspline_wang.h"
#include "fit/family.h"
#include "fit/fit.h"
#include "fit/griddata.h"
#include "fit/noise_estimate.h"
#include "fit/plane.h"
#include "fit/selection.h"

#include <map>

namespace fettle::fit {

namespace {

const std::map<std::string, Fit (*)(const FitInput&)>& methods()
{
    static const std::map<std::string, Fit (*)(const FitInput&)> table = {
        {"bspline", fit_bspline},
        {"bspline-wang", fit_bspline_wang},
        {"griddata", fit_griddata},
        {"plane", fit_plane},
    };
    return table;
}

Fit fit_by(const FitInput& input, const std::string& method)
{
    if (method == "auto") return fit_auto(input);
    const auto own = methods().find(method);
    return own != methods().end() ? own->second(input) : fit_family_by_name(input, method);
}

} // namespace

const std::vector<std::string>& fit_methods()
{
    static const std::vector<std::string> names = [] {
        std::vector<std::string> all = family_names(); // plane among them
        for (const auto& [name, fit] : methods())
            if (name != "plane") all.push_back(name);
        return all;
    }();
    return names;
}

Fit fit_surface(const FitInput& input, const std::string& method)
{
    return input.estimate_noise ? fit_with_estimated_noise(input, method, fit_by) : fit_by(input, method);
}

} // namespace fettle::fit
