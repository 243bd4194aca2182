#include "core/digest.h"

#include <sys/types.h>

#include <sha2.h>

#include <array>

namespace fettle::core {

struct Digest::State {
    SHA2_CTX context;
};

Digest::Digest() : state_(std::make_unique<State>()) { SHA256Init(&state_->context); }
Digest::Digest(Digest&&) noexcept = default;
Digest& Digest::operator=(Digest&&) noexcept = default;
Digest::~Digest() = default;

Digest& Digest::add(std::string_view bytes)
{
    SHA256Update(&state_->context, reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
    return *this;
}

std::string Digest::text(std::string_view more) const
{
    SHA2_CTX context = state_->context; // the end would spoil it
    SHA256Update(&context, reinterpret_cast<const std::uint8_t*>(more.data()), more.size());
    std::array<char, SHA256_DIGEST_STRING_LENGTH> digits;
    SHA256End(&context, digits.data());
    return digits.data();
}

std::string sha256(std::string_view bytes) { return Digest().text(bytes); }

} // namespace fettle::core
