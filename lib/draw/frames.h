#pragma once

#include "cli/tool.h"

#include <cstddef>
#include <string>
#include <vector>

namespace fettle::draw {

/// The options --frames and --frames-in of a tool that works over time, and the pictures that they ask for: PNGs in a
/// folder, and frames.json, which says when each was (docs/formats.md).
class Frames {
  public:
    explicit Frames(cli::Tool& tool);

    bool wanted() const { return count_ > 0; }
    /// Checks before any work, after parse(), that the folder is there or can be made. @throws InputError
    void check_folder() const;
    /// Pictures that are wanted, at the end of equal parts of the run; fewer where a step takes longer than one of
    /// them.
    std::size_t count() const { return static_cast<std::size_t>(count_); }
    /// The steps of a run after which a picture is wanted, ascending: of `steps` equal ones, the last among them.
    std::vector<std::size_t> steps(std::size_t steps) const;
    /// As above, of steps that end at these times, ascending.
    std::vector<std::size_t> steps(const std::vector<double>& ends) const;

    /// Adds a picture. @param time  since the start of the run, s   @param png  bytes
    void add(double time, const std::string& png);
    /// Writes frames.json. @param shown  what the pictures show, for their caption
    void finish(const std::string& shown);

  private:
    cli::Tool& tool_;
    const int& count_;
    const std::string& folder_;
    std::vector<double> times_;
    std::vector<std::string> names_;
};

} // namespace fettle::draw
