#pragma once

#include "cli/outputs.h"
#include "cli/tool.h"

#include <tbb/global_control.h>

#include <deque>
#include <map>

namespace CLI {
class App;
}

namespace fettle::cli {

inline constexpr int kDefaultSeed = 1;

/// What the declarations of a tool's options and its run share.
struct Tool::State {
    State(int count, char** values, const std::string& description);
    ~State();

    /// Sets `format`. @throws InputError if the name of an output has a suffix of another format
    void check_formats();

    std::unique_ptr<CLI::App> app;
    int argc;
    char** argv;
    std::string name;
    // Appending to a deque keeps references valid, which the declarations return.
    std::deque<bool> flags;
    std::deque<double> numbers;
    std::deque<std::optional<double>> optional_numbers;
    std::deque<int> counts;
    std::deque<std::string> texts;
    std::deque<std::vector<std::string>> file_lists; ///< of inputs
    std::deque<std::vector<std::string>> text_lists;
    std::deque<std::optional<units::Units::Length>> units;
    std::map<std::string, std::vector<std::string>> optional_values; ///< choices of options with an optional value
    std::string example;
    std::string reference;

    std::string output = "-";
    std::vector<std::string> output_formats; ///< suffixes that the main output may have; none: any
    std::string default_format;              ///< of stdout, and of a name without a suffix
    std::string format;                      ///< of --format; after parse() that of the main output
    struct FileFormats {
        const std::string* path;
        std::vector<std::string> formats;
    };
    std::vector<FileFormats> file_formats; ///< of the other outputs
    std::string report_path;
    double seed = kDefaultSeed;
    int threads = 0;
    bool quiet = false;
    bool verbose = false;

    json::Value report;
    std::unique_ptr<tbb::global_control> thread_limit;
    Outputs outputs;
    const std::string* main_input = nullptr;
    bool has_output = true;
    std::vector<std::string> warnings;
    std::vector<std::string> faults;
};

} // namespace fettle::cli
