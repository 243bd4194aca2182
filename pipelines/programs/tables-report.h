#pragma once

#include "core/constants.h"
#include "tables-values.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <ostream>
#include <string>
#include <vector>

/// Rows of the tables that set measured figures beside published ones.
namespace fettle::study {

/// Griddata is within 25 % of Table 4-5; without a bar, "as published" means the same.
inline constexpr double kRatioTolerance = 0.25;
inline constexpr double kPointsPerArea = 0.22; // eq. 4-3, 1/in²

inline std::string padded(const std::string& words, std::size_t width)
{
    return words + std::string(width - std::min(width, words.size()), ' ');
}

/// Standard error of the mean; infinite for one value.
inline double standard_error(const std::vector<double>& x)
{
    return x.size() < 2 ? core::kInfinity : deviation(x) / std::sqrt(static_cast<double>(x.size()));
}

inline std::string number(double value)
{
    std::array<char, 32> text;
    std::snprintf(text.data(), text.size(), value >= 100 ? "%9.0f" : value >= 10 ? "%9.1f" : "%9.4f", value);
    return text.data();
}

class Report {
  public:
    Report(std::ostream& out, const Values& values) : out_(out), values_(values) {}

    void title(const std::string& words)
    {
        out_ << "\n" << words << "\n" << padded("", 44) << "published     here  ratio\n";
    }

    const Values& values() const { return values_; }
    const std::vector<double>& of(const std::string& name) const { return measured(values_, name); }

    /// Without a bar.
    void shown(const std::string& what, double published, double here)
    {
        const double ratio = here / published;
        row(what, published, here,
            ratio < 1 - kRatioTolerance   ? "lower"
            : ratio > 1 + kRatioTolerance ? "higher"
                                          : "as published");
    }
    void near(const std::string& what, double published, double here, double standard_error)
    {
        const double off = std::abs(here / published - 1) - kRatioTolerance;
        row(what, published, here, verdict(off <= 0, off * published, standard_error, "within 25 %"));
    }
    /// The mean of one figure of each search.
    void near(const std::string& what, double published, const std::vector<double>& searches)
    {
        near(what, published, mean(searches), standard_error(searches));
    }
    void at_most(const std::string& what, double published, double here)
    {
        row(what, published, here, verdict(here <= published, "no more"));
    }
    /// Is the published figure one that may be drawn, from the 1st percentile of one setup to the 99th of another?
    void drawn(const std::string& what, double published, const std::vector<double>& low,
               const std::vector<double>& high)
    {
        const double from = quantile(low, 0.01), to = quantile(high, 0.99);
        std::string words = "between" + number(from) + " and" + number(to);
        row(what, published, quantile(high, 0.5), verdict(published >= from && published <= to, words));
    }
    /// What the paper concludes.
    void holds(const std::string& what, bool true_here)
    {
        out_ << padded("  " + what, 70) << verdict(true_here, "holds") << "\n";
    }
    /// Tests an inequality whose sides are estimated: value > 0, give or take its standard error.
    void holds(const std::string& what, double value, double standard_error)
    {
        out_ << padded("  " + what, 70) << verdict(value > 0, -value, standard_error, "holds") << "\n";
    }
    void words(const std::string& what) { out_ << "  " << what << "\n"; }

    int missed() const { return missed_; }

  private:
    void row(const std::string& what, double published, double here, const std::string& words)
    {
        std::array<char, 16> ratio;
        std::snprintf(ratio.data(), ratio.size(), "%7.2f", here / published);
        out_ << padded("  " + what, 44) << number(published) << number(here) << ratio.data() << "  " << words << "\n";
    }
    std::string verdict(bool reached, const std::string& words)
    {
        if (!reached) ++missed_;
        return words + (reached ? ": yes" : ": no   MISSED");
    }
    /// Not missed where the figure is beyond the bar by less than twice its standard error: more searches would tell.
    std::string verdict(bool reached, double beyond, double standard_error, const std::string& words)
    {
        if (!reached && !(beyond > 2 * standard_error)) return words + ": too few searches to tell";
        return verdict(reached, words);
    }

    std::ostream& out_;
    const Values& values_;
    int missed_ = 0;
};

} // namespace fettle::study
