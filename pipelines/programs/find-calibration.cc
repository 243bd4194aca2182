// How honest the probabilities of fettle-find are:    find-calibration SCORE.csv...
//
// SCORE.csv are find-score's, in folders named PART_CASE; `under` and `side` after a part's name are views of it. A
// line for each range of probabilities: finds said so, how many of them are right. Then the same after the log odds
// were fitted to the finds, a slope for the score, one for the logarithm of how many doubtful others there are, and an
// offset (Platt 1999), each part's by the finds of all other parts, and these three from all parts. Exit 1 if of finds
// said 0.85 to 0.95 a share outside of that range is right.
#include "core/error.h"
#include "find/evidence.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

using namespace fettle;

namespace {

struct Find {
    std::string part, view;
    double probability;
    bool is_right;
    double height, area;
    Eigen::Vector3d terms; ///< of the log odds: score, log(1 + doubtful others), 1
};

struct Calibration {
    Eigen::Vector3d weights{1, 0, 0}; ///< of these terms

    double sure(const Find& find) const { return 1 / (1 + std::exp(-weights.dot(find.terms))); }
    double probability(const Find& find) const { return (1 - find::kUnforeseenShare) * sure(find); }
};

/// bestboatunder of FOLDER/bestboatunder_3/score.csv.
std::string view_of(const std::string& path)
{
    const std::string folder = path.substr(0, path.rfind('/'));
    const std::string name = folder.substr(folder.rfind('/') + 1);
    return name.substr(0, name.find('_'));
}

/// bestboat of bestboatunder.
std::string part_of(std::string name)
{
    for (const std::string view : {"under", "side"})
        if (name.size() > view.size() && name.ends_with(view)) name.resize(name.size() - view.size());
    return name;
}

std::vector<Find> read_finds(const std::string& path)
{
    std::ifstream in(path);
    if (!in) throw core::InputError(path, "cannot be read");
    std::vector<Find> finds;
    for (std::string line; std::getline(in, line);) {
        if (!line.starts_with("find,")) continue;
        std::ranges::replace(line, ',', ' ');
        std::istringstream words(line);
        std::string kind;
        int is_right = 0;
        double p = 0, height = 0, area = 0, score = 0, others = 0;
        words >> kind >> is_right >> p >> height >> area >> score >> others;
        if (!words) throw core::InputError(path, "not a row of find-score: " + line);
        finds.push_back({part_of(view_of(path)), view_of(path), p, is_right != 0, height, area,
                         Eigen::Vector3d(score, std::log1p(others), 1)});
    }
    return finds;
}

/// Whether two finds are one feature of a part, in two cases of a view.
bool is_same_feature(const Find& a, const Find& b)
{
    constexpr double kHeightRatio = 1.05, kAreaRatio = 1.25;
    return !a.is_right && !b.is_right && a.view == b.view &&
           std::abs(std::log(a.height / b.height)) < std::log(kHeightRatio) &&
           std::abs(std::log(a.area / b.area)) < std::log(kAreaRatio);
}

constexpr double kMinProbability = 1e-12; // keeps a loss finite

double loss_of(const std::vector<Find>& finds, const Calibration& calibration)
{
    double loss = 0;
    for (const Find& find : finds) {
        const double p = std::max(calibration.probability(find), kMinProbability);
        loss -= std::log(find.is_right ? p : 1 - p);
    }
    return loss;
}

/// By Fisher's scores with halved steps: dp/dw = p (1 - s) terms, where s is the probability without the unforeseen.
Calibration fit(const std::vector<Find>& finds)
{
    Calibration best;
    for (int step = 0; step < 50; ++step) {
        Eigen::Vector3d gradient(0, 0, 0);
        Eigen::Matrix3d curvature = 1e-6 * Eigen::Matrix3d::Identity();
        for (const Find& find : finds) {
            const double p = std::max(best.probability(find), kMinProbability), change = p * (1 - best.sure(find));
            gradient += (p - find.is_right) * change / (p * (1 - p)) * find.terms;
            curvature += change * change / (p * (1 - p)) * find.terms * find.terms.transpose();
        }
        Eigen::Vector3d change = curvature.ldlt().solve(gradient);
        const auto changed = [&] { return Calibration{best.weights - change}; };
        while (change.norm() > 1e-9 && loss_of(finds, changed()) > loss_of(finds, best)) change /= 2;
        best = changed();
    }
    return best;
}

using Said = std::pair<double, bool>;

/// Prints the table. @return  whether the finds said 0.9 are as often right
bool judge(const char* title, const std::vector<Said>& finds)
{
    constexpr double kRanges[][2] = {{0.05, 0.3}, {0.3, 0.5}, {0.5, 0.7}, {0.7, 0.85}, {0.85, 0.95}, {0.95, 1}};
    std::printf("%s\n", title);
    bool is_honest = false;
    for (const auto& [low, high] : kRanges) {
        int count = 0, right = 0;
        double sum = 0;
        for (const auto& [p, is_right] : finds)
            if (p >= low && (p < high || high == 1)) ++count, right += is_right, sum += p;
        const double n = std::max(1, count), share = right / n;
        std::printf("  said %.2f to %.2f, %.3f in the mean: %4d finds, right %.3f, standard error %.3f\n", low, high,
                    sum / n, count, share, std::sqrt(std::max(share * (1 - share), 1 / (n + 2) / 4) / n));
        if (high == 0.95) is_honest = count > 0 && share >= 0.85 && share <= 0.95;
    }
    return is_honest;
}

} // namespace

int main(int argc, char** argv)
try {
    std::vector<Find> finds;
    std::set<std::string> parts;
    for (int i = 1; i < argc; ++i)
        for (Find& find : read_finds(argv[i])) {
            parts.insert(find.part);
            if (std::ranges::none_of(finds, [&](const Find& other) { return is_same_feature(find, other); }))
                finds.push_back(std::move(find));
        }
    std::vector<Said> said, left_out;
    for (const Find& find : finds) said.emplace_back(find.probability, find.is_right);
    std::printf("%zu finds on %zu parts\n", finds.size(), parts.size());
    const bool is_honest = judge("as fettle-find says it", said);
    for (const std::string& part : parts) {
        std::vector<Find> others;
        for (const Find& find : finds)
            if (find.part != part) others.push_back(find);
        const Calibration calibration = fit(others);
        for (const Find& find : finds)
            if (find.part == part) left_out.emplace_back(calibration.probability(find), find.is_right);
    }
    judge("calibrated by other parts", left_out);
    const Calibration all = fit(finds);
    std::printf("log odds: %.3f of the score, %.3f of log(1 + doubtful others), %.3f\n", all.weights[0], all.weights[1],
                all.weights[2]);
    return is_honest ? 0 : 1;
} catch (const core::InputError& error) {
    std::fprintf(stderr, "find-calibration: %s\n", error.what());
    return 2;
}
