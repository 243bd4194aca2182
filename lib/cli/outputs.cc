#include "cli/outputs.h"

#include "core/error.h"

#include <algorithm>
#include <csignal>
#include <fcntl.h>
#include <filesystem>
#include <system_error>
#include <unistd.h>

namespace fettle::cli {

void guard_standard_streams()
{
    // /dev/null takes the number of a closed stream, opened so that reading or writing fails.
    for (const int number : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
        if (fcntl(number, F_GETFD) == -1) open("/dev/null", number == STDIN_FILENO ? O_WRONLY : O_RDONLY);
    std::signal(SIGXFSZ, [](int) {}); // a handler rather than SIG_IGN, which child processes would inherit
}

void Outputs::declare(const std::string& path, const std::string* may_replace)
{
    declared_.push_back({&path, may_replace});
}

void Outputs::open(const std::string* main_output, const std::string* main_input)
{
    if (main_output != nullptr) {
        reserve(*main_output, main_input);
        main_ = std::make_unique<core::OutputFile>(*main_output);
    }
    for (const auto& [path, may_replace] : declared_) {
        if (path->empty()) continue;
        reserve(*path, may_replace);
        others_.emplace_back(*path);
    }
}

void Outputs::reserve(const std::string& path, const std::string* may_replace)
{
    if (path == "/dev/null") return; // may be named for several outputs
    for (const std::string& other : reserved_)
        if (core::same_file(path, other))
            throw core::InputError(path == "-" ? "stdout" : path, "named for two outputs");
    if (std::error_code unknown; std::filesystem::is_regular_file(path, unknown))
        for (const std::string* input : inputs_)
            if (input != may_replace && core::same_file(path, *input))
                throw core::InputError(path, "is an input, which would be lost: another name is needed for the output");
    reserved_.push_back(path);
}

std::ostream& Outputs::main()
{
    uses_main_ = true;
    return main_->stream();
}

std::ostream& Outputs::file(const std::string& path)
{
    auto other = std::ranges::find(others_, path, &Other::path);
    if (other == others_.end()) {
        reserve(path);
        other = others_.emplace(others_.end(), path);
    }
    other->is_used = true;
    return other->file.stream();
}

void Outputs::commit()
{
    std::erase_if(others_, [](const Other& other) { return !other.is_used; });
    // All data are written before the first file gets its name.
    for (Other& other : others_) other.file.sync();
    if (uses_main_) main_->sync();
    // stdout comes last: the program that reads the pipe may need the other files.
    for (Other& other : others_) other.file.commit();
    if (uses_main_) main_->commit();
}

} // namespace fettle::cli
