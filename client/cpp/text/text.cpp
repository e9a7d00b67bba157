#include "client/cpp/text/text.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <sstream>

#include "proto/resource_kinds.h"

namespace tribodyn::client {
namespace {

#define TRIBODYN_COLLECTION(Resource, field, collection, seed) #collection,
constexpr std::string_view kCollections[] = {
    TRIBODYN_RESOURCE_KINDS(TRIBODYN_COLLECTION) "simulations", "campaigns"};
#undef TRIBODYN_COLLECTION

}  // namespace

int display_width(std::string_view text) {
  return static_cast<int>(std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U;  // not a continuation byte
  }));
}

bool is_utf8(std::string_view text) {
  const auto byte = [&](std::size_t at) {
    return at < text.size() ? static_cast<unsigned char>(text[at]) : 0U;
  };
  for (std::size_t i = 0; i < text.size();) {
    const unsigned first = byte(i);
    const std::size_t size = first < 0x80 ? 1 : first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
    if (size > 1 && (first < 0xc2 || first > 0xf4)) return false;
    for (std::size_t k = 1; k < size; ++k) {
      if ((byte(i + k) & 0xc0U) != 0x80U) return false;
    }
    const unsigned second = byte(i + 1);
    const bool overlong = (first == 0xe0 && second < 0xa0) || (first == 0xf0 && second < 0x90);
    const bool surrogate = first == 0xed && second > 0x9f;
    const bool too_large = first == 0xf4 && second > 0x8f;
    if (overlong || surrogate || too_large) return false;
    i += size;
  }
  return true;
}

std::string printable(std::string_view text) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    // The C1 controls are C2 80 to C2 9F in UTF-8.
    const bool is_c1 =
        byte == 0xC2U && i + 1 < text.size() && static_cast<unsigned char>(text[i + 1]) < 0xA0U;
    if (text[i] == '\n' || text[i] == '\t') {
      result += ' ';
    } else if (is_c1) {
      result += '?';
      ++i;
    } else {
      result += byte < 0x20U || byte == 0x7FU ? '?' : text[i];
    }
  }
  return result;
}

std::string fixed(double value, int decimals) {
  if (!std::isfinite(value)) return "-";
  std::array<char, 400> buffer;
  std::snprintf(buffer.data(), buffer.size(), "%.*f", decimals, value);
  std::string text = buffer.data();
  if (text[0] == '-' && text.find_first_not_of("-0.") == std::string::npos) text.erase(0, 1);
  return text;
}

std::string signed_fixed(double value, int decimals) {
  const std::string text = fixed(value, decimals);
  return (value > 0 && text.find_first_of("123456789") != text.npos ? "+" : "") + text;
}

std::string significant(double value, int digits) {
  if (!std::isfinite(value)) return "-";
  std::array<char, 64> buffer;
  std::snprintf(buffer.data(), buffer.size(), "%.*g", digits, value);
  return buffer.data();
}

std::string shortest(double value) {
  if (std::isnan(value)) return "NaN";
  if (std::isinf(value)) return value > 0 ? "Infinity" : "-Infinity";
  std::array<char, 64> buffer;
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
  return std::string(buffer.data(), end);
}

std::string duration_text(double seconds) {
  if (seconds > 0 && seconds < 0.9995)
    return fixed(1e3 * seconds, seconds < 9.95e-3 ? 1 : 0) + " ms";
  if (seconds < 59.95) return fixed(seconds, 1) + " s";
  const auto whole = static_cast<long>(std::lround(seconds));
  std::array<char, 64> buffer;
  if (whole < 3600) {
    std::snprintf(buffer.data(), buffer.size(), "%ld min %02ld s", whole / 60, whole % 60);
  } else {
    std::snprintf(buffer.data(), buffer.size(), "%ld h %02ld min", whole / 3600, whole / 60 % 60);
  }
  return buffer.data();
}

std::string wrapped(std::string_view text, int indent, int width) {
  std::istringstream words{std::string(text)};
  std::string result;
  std::string line;
  for (std::string word; words >> word;) {
    if (!line.empty() && indent + display_width(line) + 1 + display_width(word) > width) {
      result += std::string(indent, ' ') + line + "\n";
      line.clear();
    }
    line += (line.empty() ? "" : " ") + word;
  }
  if (!line.empty()) result += std::string(indent, ' ') + line + "\n";
  return result;
}

std::vector<std::string> split(std::string_view text, char separator) {
  std::vector<std::string> parts;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(separator), text.size());
    parts.emplace_back(text.substr(0, end));
    if (end == text.size()) break;
    text.remove_prefix(end + 1);
    if (text.empty()) parts.emplace_back();
  }
  return parts;
}

std::string joined(const std::vector<std::string>& parts, std::string_view separator) {
  std::string text;
  for (const std::string& part : parts) {
    if (!text.empty()) text += separator;
    text += part;
  }
  return text;
}

std::string resource_name(std::string_view collection, std::string_view id_or_name) {
  if (id_or_name.find('/') != std::string_view::npos) return std::string(id_or_name);
  return std::string(collection) + "/" + std::string(id_or_name);
}

std::string resource_id(std::string_view name) {
  constexpr std::string_view kProjects = "projects/";
  std::string_view relative = name;
  if (name.starts_with(kProjects)) {
    relative.remove_prefix(std::min(name.size(), name.find('/', kProjects.size())));
    if (!relative.empty()) relative.remove_prefix(1);
  }
  const std::size_t slash = relative.find('/');
  if (slash == std::string_view::npos) return std::string(name);
  const std::string_view id = relative.substr(slash + 1);
  const bool is_name = id.find('/') == std::string_view::npos &&
                       std::find(std::begin(kCollections), std::end(kCollections),
                                 relative.substr(0, slash)) != std::end(kCollections);
  return std::string(is_name ? id : name);
}

}  // namespace tribodyn::client
