#include "fit/report.h"

#include "fit/dense.h"
#include "fit/fit.h"
#include "json/document.h"

namespace fettle {

void report(json::Value& out, const Fit& fit)
{
    const double mm = fit.surface.units.mm();
    out.set("method", fit.surface.method)
        .set("touches", static_cast<int>(fit.surface.touches.cols()))
        .set("ignored", fit.surface.ignored)
        .set("iterations", fit.iterations)
        .set("rms", fit.surface.rms / mm)
        .set("max_abs", fit.residuals.cwiseAbs().maxCoeff() / mm)
        .set("touch_sigma", fit.surface.touch_sigma / mm)
        .set("goodness", fit.surface.goodness)
        .set("touch_freedom", fit.surface.touch_freedom)
        .set("weight", fit.surface.weight)
        .set("gross_errors", static_cast<int>(fit.surface.gross_errors.size()));
    if (fit.surface.alternatives.empty()) return;
    std::vector<json::Value> scores(1);
    scores[0].set("method", fit.surface.method).set("score", fit.surface.score).set("weight", fit.surface.weight);
    for (const Alternative& other : fit.surface.alternatives) {
        scores.emplace_back();
        scores.back().set("method", other.method).set("score", other.score).set("weight", other.weight);
    }
    out.set("scores", scores);
}

void report(json::Value& out, const DenseFit& dense)
{
    const Surface& surface = dense.fit.surface;
    const double mm = surface.units.mm();
    out.set("method", surface.method)
        .set("touches", dense.counts.used)
        .set("ignored", dense.counts.ignored())
        .set("undefined", dense.counts.undefined)
        .set("other_role", dense.counts.other_role)
        .set("inside_anomaly", dense.counts.anomaly)
        .set("outside_sampling", dense.counts.outside)
        .set("outliers", dense.outliers)
        .set("iterations", dense.fit.iterations)
        .set("rms", surface.rms / mm)
        .set("touch_sigma", surface.touch_sigma / mm)
        .set("goodness", surface.goodness);
}

} // namespace fettle
