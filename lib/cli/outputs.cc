#include "cli/outputs.h"

#include "core/error.h"

#include <algorithm>
#include <csignal>
#include <fcntl.h>
#include <filesystem>
#include <system_error>
#include <unistd.h>

namespace fettle {

// Where stdin, stdout or stderr is closed, the next file that is opened would be taken for it: something else goes
// there, of which reading, or writing, fails as it should.
void prepare_to_write()
{
    for (const int number : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
        if (fcntl(number, F_GETFD) == -1) open("/dev/null", number == STDIN_FILENO ? O_WRONLY : O_RDONLY);
    std::signal(SIGXFSZ, [](int) {}); // programs that are started get it anew
}

void Outputs::declare(const std::string& path, const std::string* may_replace)
{
    declared_.push_back({&path, may_replace});
}

void Outputs::open(const std::string* bulk, const std::string* bulk_input)
{
    if (bulk != nullptr) {
        claim(*bulk, bulk_input);
        bulk_ = std::make_unique<OutputFile>(*bulk);
    }
    for (const auto& [path, may_replace] : declared_) {
        if (path->empty()) continue;
        claim(*path, may_replace);
        others_.emplace_back(*path);
    }
}

void Outputs::claim(const std::string& path, const std::string* may_replace)
{
    if (path == "/dev/null") return; // as often as one likes
    for (const std::string& other : claimed_)
        if (same_file(path, other)) throw InputError(path == "-" ? "stdout" : path, "named for two outputs");
    if (std::error_code unknown; std::filesystem::is_regular_file(path, unknown))
        for (const std::string* input : inputs_)
            if (input != may_replace && same_file(path, *input))
                throw InputError(path, "is an input, which would be lost: another name is needed for the output");
    claimed_.push_back(path);
}

std::ostream& Outputs::bulk()
{
    has_bulk_ = true;
    return bulk_->stream();
}

std::ostream& Outputs::file(const std::string& path)
{
    auto at = std::find_if(others_.begin(), others_.end(), [&](const Other& other) { return other.path == path; });
    if (at == others_.end()) {
        claim(path);
        at = others_.emplace(others_.end(), path);
    }
    at->is_used = true;
    return at->file.stream();
}

// Named outputs first, stdout last: a reader of the pipe may rely on the files.
void Outputs::commit()
{
    std::erase_if(others_, [](const Other& other) { return !other.is_used; });
    // All or none, as far as it goes: where one cannot be written none gets its name.
    for (Other& other : others_) other.file.settle();
    if (has_bulk_) bulk_->settle();
    for (Other& other : others_) other.file.commit();
    if (has_bulk_) bulk_->commit();
}

} // namespace fettle
