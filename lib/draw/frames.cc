#include "draw/frames.h"

#include "core/error.h"
#include "json/document.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <sys/stat.h>
#include <unistd.h>

namespace fettle::draw {

Frames::Frames(cli::Tool& tool)
    : tool_(tool),
      count_(tool.count("--frames", 0,
                        "Up to so many pictures of the stock during the run, PNG, at equal times; 0: none", 0, 500)),
      folder_(tool.text("--frames-in", "frames", "FOLDER",
                        "With --frames: where they go, and frames.json, which fettle-report --frames plays"))
{
}

void Frames::check_folder() const
{
    if (!wanted()) return;
    const std::filesystem::path folder(folder_);
    const bool exists = std::filesystem::exists(folder);
    const std::filesystem::path parent = folder.has_parent_path() ? folder.parent_path() : ".";
    const auto refuse = [&](int error) {
        throw core::InputError(folder_, std::string("no folder for pictures: ") + std::strerror(error));
    };
    if (exists && !std::filesystem::is_directory(folder)) refuse(ENOTDIR);
    if (::access((exists ? folder : parent).c_str(), W_OK | X_OK) != 0) refuse(errno);
}

std::vector<std::size_t> Frames::steps(std::size_t steps) const
{
    std::vector<double> ends(steps);
    for (std::size_t i = 0; i < steps; ++i) ends[i] = double(i + 1);
    return this->steps(ends);
}

std::vector<std::size_t> Frames::steps(const std::vector<double>& ends) const
{
    std::vector<std::size_t> wanted;
    if (ends.empty()) return wanted;
    for (std::size_t k = 1; k <= count(); ++k) {
        const double time = ends.back() * double(k) / double(count());
        const auto at = std::min(std::ranges::lower_bound(ends, time), ends.end() - 1);
        const auto step = static_cast<std::size_t>(at - ends.begin());
        if (wanted.empty() || step > wanted.back()) wanted.push_back(step);
    }
    return wanted;
}

void Frames::add(double time, const std::string& png)
{
    if (names_.empty() && ::mkdir(folder_.c_str(), 0777) != 0 && errno != EEXIST)
        throw core::InputError(folder_, std::string("no folder for pictures: ") + std::strerror(errno));
    const std::string number = std::to_string(names_.size() + 1);
    constexpr std::size_t kDigits = 3;
    names_.push_back(std::string(kDigits - std::min(kDigits, number.size()), '0') + number + ".png");
    times_.push_back(time);
    tool_.output_file(folder_ + "/" + names_.back()) << png;
}

void Frames::finish(const std::string& shown)
{
    if (names_.empty()) return;
    std::vector<json::Value> frames;
    for (std::size_t i = 0; i < names_.size(); ++i)
        frames.push_back(json::Value().set("t", times_[i]).set("picture", names_[i]));
    tool_.output_file(folder_ + "/frames.json")
        << json::Value().set("kind", "frames").set("shown", shown).set("frames", frames);
}

} // namespace fettle::draw
