#pragma once

#include <functional>
#include <string>
#include <vector>

namespace fettle {

/// Asks the operator, on stderr and stdin where both are terminals; what is no terminal answers unasked, a line each.
/// An empty line or none: the answer is `otherwise`. A bad answer is asked for again on a terminal, else refused.
class Questions {
  public:
    /// @param listens  else stdin is not read, and every answer is `otherwise`
    explicit Questions(bool listens);

    /// A hint, if there is somebody to read it.
    void say(const std::string& text) const;
    /// @throws InputError
    std::string choose(const std::string& what, const std::vector<std::string>& choices, const std::string& otherwise);
    double number(const std::string& what, double otherwise);

  private:
    std::string ask(const std::string& what, const std::string& otherwise, const std::string& fault,
                    const std::function<bool(const std::string&)>& fine);

    bool listens_, asks_;
};

} // namespace fettle
