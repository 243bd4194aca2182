#include "robot/urdf.h"

#include "core/error.h"
#include "core/file.h"
#include "core/xml.h"
#include "robot/urdf_model.h"

#include <console_bridge/console.h>
#include <urdf_parser/urdf_parser.h>

#include <algorithm>
#include <cctype>

namespace fettle::robot {

namespace {

// Names and numbers of a file stand in messages, and may hold line ends.
std::string in_one_line(std::string text)
{
    std::ranges::replace_if(
        text, [](unsigned char c) { return std::iscntrl(c) != 0; }, ' ');
    return text;
}

/// Keeps liburdfdom's messages from the screen, and the first one of them.
class FirstMessage : public console_bridge::OutputHandler {
  public:
    FirstMessage() { console_bridge::useOutputHandler(this); }
    ~FirstMessage() override { console_bridge::restorePreviousOutputHandler(); }
    void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override
    {
        if (text_.empty() && level >= console_bridge::CONSOLE_BRIDGE_LOG_ERROR) text_ = text;
    }
    const std::string& text() const { return text_; }

  private:
    std::string text_;
};

} // namespace

std::map<std::string, std::string> parse_packages(const std::string& text)
{
    std::map<std::string, std::string> packages;
    for (std::size_t from = 0; from < text.size();) {
        const std::size_t end = std::min(text.find(',', from), text.size());
        const std::string one = text.substr(from, end - from);
        const std::size_t equals = one.find('=');
        if (equals == std::string::npos || equals == 0 || equals + 1 == one.size())
            throw core::InputError("--package: expected NAME=DIR, got '" + one + "'");
        packages[one.substr(0, equals)] = one.substr(equals + 1);
        from = end + 1;
    }
    return packages;
}

bool looks_like_xml(std::string_view text)
{
    const std::size_t first = text.find_first_not_of(" \t\r\n\xef\xbb\xbf");
    return first != std::string_view::npos && text[first] == '<';
}

Robot parse_urdf(const std::string& text, const std::string& source, const UrdfOptions& options)
{
    if (text.find("xacro:") != std::string::npos || text.find("${") != std::string::npos)
        throw core::InputError(source, "is a xacro file: expand it first (xacro FILE > robot.urdf)");
    core::require_plain_xml(text, source);
    FirstMessage message;
    const urdf::ModelInterfaceSharedPtr model = urdf::parseURDF(text);
    // Shapes that liburdfdom cannot read it leaves out, and says so in a message.
    if (model == nullptr || model->getRoot() == nullptr || !message.text().empty())
        throw core::InputError(source, message.text().empty() ? "is no URDF" : in_one_line(message.text()));
    try {
        return make_robot(*model, source, options);
    } catch (const core::InputError& error) {
        const std::string_view said = error.what(); // which may name the place already
        if (said.starts_with("--") || said.starts_with(source)) throw;
        if (!options.srdf.empty() && said.starts_with(core::display_name(options.srdf))) throw;
        throw core::InputError(source, in_one_line(error.what()));
    }
}

} // namespace fettle::robot
