// Weights of the logistic model of fettle-find from evidence that find-evidence has written:
//
//     find-train EVIDENCE.csv...      in folders named PART_CASE, as find.mk makes them; capitals and digits after a
//     part's name are views of it
//
// The model is additive: each feature enters by itself and by min(feature, knot) at three quartiles of the anomalies'
// values, so that its effect may level off. Candidates that cover an anomaly by more than 0.4 (intersection over union)
// are examples of anomalies, those that cover none by 0.25 of what they are not. The weights minimize the logistic loss
// with a ridge, each with the sign that its meaning demands. They are then scaled so that probabilities are right for
// parts that were not learnt from: each part's candidates are scored by weights from all others, those that remain
// without overlaps judged, and slope and offset fitted to these judgements (Platt 1999). Prints the weights, and how
// good the left-out parts' scores were.
#include "core/constants.h"
#include "core/error.h"
#include "find/evidence.h"
#include "geometry/quantiles.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

using namespace fettle;
using find::Features, find::kFeatures;

namespace {

struct Row {
    std::string part, scan;
    double iou, share, x, y, width, height;
    Features features;
    double score = 0;

    bool is_anomaly() const { return iou > 0.4; }
    bool is_example() const { return iou > 0.4 || iou < 0.25; }
    bool is_right() const { return iou > 0.3 || share > 0.3; } ///< as finds are judged
};

// Signs of the weights, in the order of features_of(); 0: either.
constexpr int kSigns[kFeatures] = {0, 1, 1, 1, 1, -1, -1, -1, 1, -1, 1, -1, 1, 0, -1, 1, 1, 1, 0, 1};
constexpr int kKnotted[] = {1, 2, 3, 4, 7, 10, 14, 15, 16, 17, 19}; // features with knots
constexpr double kRidge = 30;                                       // of weights of terms of unit variance
constexpr double kMaxExamples = 60; // a part's weight on either side, so that none rules
constexpr int kSweeps = 60;

std::vector<Row> read_rows(const std::string& path)
{
    std::ifstream in(path);
    const std::string scan = std::filesystem::absolute(path).parent_path().filename();
    std::string part = scan.substr(0, scan.find('_'));
    while (part.size() > 2 && !(part.back() >= 'a' && part.back() <= 'z')) part.pop_back();
    std::vector<Row> rows;
    for (std::string line; std::getline(in, line);) {
        if (!line.starts_with("candidate,")) continue;
        std::ranges::replace(line, ',', ' ');
        std::istringstream words(line);
        std::string kind;
        int number = 0; // of the anomaly
        words >> kind >> number;
        Row row{part, scan, 0, 0, 0, 0, 0, 0, {}, 0};
        words >> row.iou >> row.share >> row.x >> row.y >> row.width >> row.height;
        for (double& feature : row.features) words >> feature;
        if (!words) throw core::InputError(path, "not a row of find-evidence");
        rows.push_back(row);
    }
    return rows;
}

/// Weights of examples: no part counts more than kMaxExamples on either side.
std::vector<double> balance(const std::vector<const Row*>& rows)
{
    std::map<std::pair<std::string, bool>, double> counts;
    for (const Row* row : rows) ++counts[{row->part, row->is_anomaly()}];
    std::vector<double> weights;
    for (const Row* row : rows) weights.push_back(std::min(1.0, kMaxExamples / counts[{row->part, row->is_anomaly()}]));
    return weights;
}

/// A term of the model: weight times min(feature, knot).
struct Term {
    int feature;
    double knot;
    double weight = 0;

    double of(const Features& features) const { return std::min(features[feature], knot); }
};
using Model = std::vector<Term>;

Model empty_model(const std::vector<const Row*>& rows)
{
    Model model;
    for (int k = 0; k < kFeatures; ++k) model.push_back({k, core::kInfinity});
    for (const int k : kKnotted) {
        std::vector<double> values;
        for (const Row* row : rows)
            if (row->is_anomaly()) values.push_back(row->features[k]);
        for (const double share : {0.25, 0.5, 0.75}) model.push_back({k, geometry::quantile(values, share)});
    }
    return model;
}

double score_of(const Model& model, const Features& features)
{
    double score = 0;
    for (const Term& term : model) score += term.weight * term.of(features);
    return score;
}

/// Logistic regression with ridge and signs by cyclic coordinate descent.
Model fit(const std::vector<const Row*>& rows)
{
    Model model = empty_model(rows);
    const auto count = Eigen::Index(rows.size()), terms = Eigen::Index(model.size());
    const std::vector<double> weights = balance(rows);
    Eigen::MatrixXd Z(count, terms);
    for (Eigen::Index i = 0; i < count; ++i)
        for (Eigen::Index k = 0; k < terms; ++k) Z(i, k) = model[std::size_t(k)].of(rows[std::size_t(i)]->features);
    Eigen::VectorXd mean = Z.colwise().mean(), sd = Eigen::VectorXd::Ones(terms);
    mean[0] = 0;
    Z.rowwise() -= mean.transpose();
    for (Eigen::Index k = 1; k < terms; ++k) sd[k] = std::sqrt(Z.col(k).squaredNorm() / double(count)) + 1e-6;
    Z = Z * sd.cwiseInverse().asDiagonal();
    Eigen::VectorXd w = Eigen::VectorXd::Zero(terms), scores = Eigen::VectorXd::Zero(count);
    for (int sweep = 0; sweep < kSweeps; ++sweep)
        for (Eigen::Index k = 0; k < terms; ++k) {
            double gradient = k == 0 ? 0 : kRidge * w[k], curvature = k == 0 ? 1e-9 : kRidge;
            for (Eigen::Index i = 0; i < count; ++i) {
                const double p = 1 / (1 + std::exp(-scores[i])), weight = weights[std::size_t(i)];
                gradient += weight * (p - rows[std::size_t(i)]->is_anomaly()) * Z(i, k);
                curvature += weight * std::max(p * (1 - p), 0.02) * Z(i, k) * Z(i, k);
            }
            double next = w[k] - gradient / curvature;
            const int sign = kSigns[model[std::size_t(k)].feature];
            if (sign > 0) next = std::max(next, 0.0);
            if (sign < 0) next = std::min(next, 0.0);
            scores += (next - w[k]) * Z.col(k);
            w[k] = next;
        }
    for (Eigen::Index k = 0; k < terms; ++k) model[std::size_t(k)].weight = w[k] / sd[k];
    model[0].weight -= (w.array() * mean.array() / sd.array()).sum();
    return model;
}

std::vector<const Row*> examples(const std::vector<Row>& rows, const std::string& without = "")
{
    std::vector<const Row*> chosen;
    for (const Row& row : rows)
        if (row.is_example() && row.part != without) chosen.push_back(&row);
    return chosen;
}

double box_overlap(const Row& a, const Row& b)
{
    const double w = std::min(a.x + a.width, b.x + b.width) - std::max(a.x, b.x);
    const double h = std::min(a.y + a.height, b.y + b.height) - std::max(a.y, b.y);
    return w > 0 && h > 0 ? w * h / std::min(a.width * a.height, b.width * b.height) : 0;
}

/// The best scored of each scan without overlaps, as fettle-find takes them.
std::vector<const Row*> survivors(const std::vector<Row>& rows)
{
    std::vector<const Row*> order, taken;
    for (const Row& row : rows) order.push_back(&row);
    std::ranges::stable_sort(order, std::greater{}, [](const Row* row) { return row->score; });
    for (const Row* row : order)
        if (std::ranges::none_of(
                taken, [&](const Row* other) { return other->scan == row->scan && box_overlap(*row, *other) > 0.3; }))
            taken.push_back(row);
    return taken;
}

double loss_of(const std::vector<const Row*>& rows, double a, double b)
{
    double loss = 0;
    for (const Row* row : rows) {
        const double s = (a * row->score + b) * (row->is_right() ? 1 : -1);
        loss += s > 0 ? std::log1p(std::exp(-s)) : std::log1p(std::exp(s)) - s;
    }
    return loss;
}

/// Slope and offset of Platt's calibration, by Newton's method with halved steps.
std::pair<double, double> calibrate(const std::vector<const Row*>& rows)
{
    Eigen::Vector2d x(0, 0);
    for (int step = 0; step < 50; ++step) {
        Eigen::Vector2d g(0, 0);
        Eigen::Matrix2d H = 1e-6 * Eigen::Matrix2d::Identity();
        for (const Row* row : rows) {
            const double p = 1 / (1 + std::exp(-x[0] * row->score - x[1]));
            const Eigen::Vector2d d(row->score, 1);
            g += (p - row->is_right()) * d;
            H += p * (1 - p) * d * d.transpose();
        }
        Eigen::Vector2d change = H.ldlt().solve(g);
        while (loss_of(rows, x[0] - change[0], x[1] - change[1]) > loss_of(rows, x[0], x[1]) && change.norm() > 1e-9)
            change /= 2;
        x -= change;
    }
    return {x[0], x[1]};
}

void judge(const std::vector<const Row*>& rows, double a, double b)
{
    for (const auto& [low, high] : {std::pair{0.3, 0.5}, {0.5, 0.7}, {0.7, 0.85}, {0.85, 0.95}, {0.95, 1.01}}) {
        int count = 0, right = 0;
        for (const Row* row : rows) {
            const double p = 1 / (1 + std::exp(-a * row->score - b));
            if (p >= low && p < high) ++count, right += row->is_right();
        }
        std::printf("said %.2f to %.2f: %d finds, right %.2f\n", low, std::min(high, 1.0), count,
                    count ? double(right) / count : 0);
    }
}

} // namespace

int main(int argc, char** argv)
{
    std::vector<Row> rows;
    std::set<std::string> parts;
    for (int i = 1; i < argc; ++i)
        for (Row& row : read_rows(argv[i])) {
            parts.insert(row.part);
            rows.push_back(std::move(row));
        }
    for (const std::string& part : parts) {
        const Model model = fit(examples(rows, part));
        for (Row& row : rows)
            if (row.part == part) row.score = score_of(model, row.features);
    }
    const std::vector<const Row*> kept = survivors(rows);
    const auto [a, b] = calibrate(kept);
    judge(kept, a, b);
    for (const std::string& part : parts) {
        int right = 0, wrong = 0;
        for (const Row* row : kept)
            if (row->part == part && a * row->score + b > 0) ++(row->is_right() ? right : wrong);
        std::printf("%s: %d right, %d wrong\n", part.c_str(), right, wrong);
    }
    for (const Term& term : fit(examples(rows))) {
        const double weight = a * term.weight + (term.feature == 0 ? b : 0);
        if (std::abs(weight) < 1e-4) continue;
        if (std::isfinite(term.knot))
            std::printf("{%d, %.4g, %.4g},\n", term.feature, term.knot, weight);
        else
            std::printf("{%d, kNoKnot, %.4g},\n", term.feature, weight);
    }
}
