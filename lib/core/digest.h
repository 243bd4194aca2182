#pragma once

#include <memory>
#include <string>
#include <string_view>

namespace fettle::core {

/// SHA-256 (FIPS 180-4) of bytes that come one after the other.
class Digest {
  public:
    Digest();
    Digest(Digest&&) noexcept;
    Digest& operator=(Digest&&) noexcept;
    ~Digest();

    Digest& add(std::string_view bytes);
    /// Digest of all bytes so far, and of `more` after them, as 64 hexadecimal digits. More can be added afterwards.
    std::string text(std::string_view more = {}) const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

/// Digits of Digest::text().
inline constexpr std::size_t kDigestDigits = 64;

/// SHA-256 of bytes as 64 hexadecimal digits.
std::string sha256(std::string_view bytes);

} // namespace fettle::core
