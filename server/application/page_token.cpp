#include "server/application/page_token.h"

#include <fmt/format.h>
#include <openssl/crypto.h>

#include <charconv>

#include "server/support/sha256.h"
#include "server/support/text.h"

namespace tribodyn::server {
namespace {

constexpr std::size_t kSealDigits = 32;  // half of an HMAC: forged by luck once in 2^128
constexpr std::size_t kLongestToken = 20'000;

std::string to_hex(const std::string& bytes) {
  std::string out;
  for (const char c : bytes) out += fmt::format("{:02x}", static_cast<unsigned char>(c));
  return out;
}

std::optional<std::string> from_hex(const std::string& hex) {
  if (hex.size() % 2 != 0 || hex.size() > kLongestToken) return std::nullopt;
  std::string out;
  for (std::size_t i = 0; i < hex.size(); i += 2) {
    unsigned int byte = 0;
    const auto [end, error] = std::from_chars(hex.data() + i, hex.data() + i + 2, byte, 16);
    if (error != std::errc() || end != hex.data() + i + 2) return std::nullopt;
    out += static_cast<char>(byte);
  }
  return out;
}

/// Proves that a server with the key wrote the text for the scope.
std::string seal(const std::string& key, const std::string& scope, const std::string& text) {
  return hmac_sha256(key, fmt::format("{}\n{}{}", scope.size(), scope, text))
      .substr(0, kSealDigits);
}

/// Compares in a time that says nothing of the place of the first difference.
bool is_same(const std::string& first, const std::string& second) {
  return first.size() == second.size() &&
         CRYPTO_memcmp(first.data(), second.data(), first.size()) == 0;
}

/// Returns the value after a letter for its kind.
std::string text_of(const PropertyValue& value) {
  if (const auto* time = std::get_if<std::int64_t>(&value)) return fmt::format("t{}", *time);
  if (const auto* number = std::get_if<double>(&value)) return fmt::format("n{}", *number);
  return "s" + std::get<std::string>(value);
}

std::optional<PropertyValue> parse_value(const std::string& text) {
  if (text.starts_with('t')) return parse_number<std::int64_t>(text.substr(1));
  if (text.starts_with('n')) return parse_number<double>(text.substr(1));
  if (text.starts_with('s')) return text.substr(1);
  return std::nullopt;
}

}  // namespace

std::string page_token(const std::string& key, const std::string& scope, const PageToken& token) {
  const std::string text =
      fmt::format("{} {} {}", token.total, token.last.name, text_of(token.last.value));
  return seal(key, scope, text) + to_hex(text);
}

std::optional<PageToken> parse_page_token(const std::string& key, const std::string& scope,
                                          const std::string& token) {
  if (token.size() < kSealDigits) return std::nullopt;
  const auto text = from_hex(token.substr(kSealDigits));
  if (!text || !is_same(token.substr(0, kSealDigits), seal(key, scope, *text))) {
    return std::nullopt;
  }
  std::string_view rest = *text;
  const auto total = parse_number<std::int64_t>(take_part(rest, ' '));
  std::string name(take_part(rest, ' '));
  auto value = parse_value(std::string(rest));
  if (!total || *total < kNotCounted || !value) return std::nullopt;
  return PageToken{{std::move(*value), std::move(name)}, *total};
}

}  // namespace tribodyn::server
