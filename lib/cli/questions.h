#pragma once

#include <functional>
#include <string>
#include <vector>

namespace fettle::cli {

/// Asks the operator: prompts on stderr and reads answers from stdin if both are terminals. Otherwise nothing is
/// printed, and each line of stdin is an answer. An empty line or the end of stdin means `fallback`. After an invalid
/// answer the question is repeated on a terminal; otherwise it is an error.
class OperatorPrompt {
  public:
    /// @param reads_stdin  if false, stdin is not read and every answer is `fallback`
    explicit OperatorPrompt(bool reads_stdin);

    /// Prints a hint if stdin and stderr are terminals.
    void print_hint(const std::string& text) const;
    /// @throws InputError
    std::string ask_choice(const std::string& what, const std::vector<std::string>& choices,
                           const std::string& fallback);
    double ask_number(const std::string& what, double fallback);

  private:
    std::string ask(const std::string& what, const std::string& fallback, const std::string& fault,
                    const std::function<bool(const std::string&)>& is_valid);

    bool reads_stdin_, is_interactive_;
};

} // namespace fettle::cli
