#include "core/error.h"
#include "fit/bspline.h"
#include "fit/bspline_wang.h"
#include "fit/cylinder.h"
#include "fit/fit.h"
#include "fit/griddata.h"
#include "fit/plane.h"
#include "fit/sphere.h"
#include "fit/swept.h"

#include <map>

namespace fettle {

namespace {

const std::map<std::string, Fit (*)(const FitInput&)>& methods()
{
    static const std::map<std::string, Fit (*)(const FitInput&)> table = {
        {"bspline", fit_bspline},   {"bspline-wang", fit_bspline_wang},
        {"cylinder", fit_cylinder}, {"griddata", fit_griddata},
        {"plane", fit_plane},       {"sphere", fit_sphere},
        {"swept", fit_swept},
    };
    return table;
}

std::string automatic(SurfaceType type)
{
    switch (type) {
    case SurfaceType::plane:
        return "plane";
    case SurfaceType::swept:
        return "swept";
    case SurfaceType::freeform:
        return "bspline";
    }
    throw std::logic_error("surface type");
}

} // namespace

const std::vector<std::string>& fit_methods()
{
    static const std::vector<std::string> names = [] {
        std::vector<std::string> all;
        for (const auto& [name, fit] : methods()) all.push_back(name);
        return all;
    }();
    return names;
}

Fit fit_surface(const FitInput& input, const std::string& method)
{
    return methods().at(method == "auto" ? automatic(input.job.surface) : method)(input);
}

} // namespace fettle
