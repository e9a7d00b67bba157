#include "server/transport/http/media_types.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>

#include "server/contract/resource_names.h"
#include "server/support/text.h"
#include "server/transport/http/rest_answer.h"

namespace tribodyn::server {
namespace {

struct Words {
  Form form;
  std::string_view word;  ///< of the query parameter
  std::string_view media_type;
};
constexpr std::array kWords = {
    Words{Form::kMessage, "json", "application/json"},
    Words{Form::kEvents, "sse", "text/event-stream"},
    Words{Form::kLines, "ndjson", "application/x-ndjson"},
    Words{Form::kColumns, "columns", "application/json"},
    Words{Form::kPointColumns, "columns", "application/vnd.tribodyn.columns+json"},
    Words{Form::kCsv, "csv", "text/csv"},
    Words{Form::kNumpy, "npy", "application/x-npy"},
    Words{Form::kBinary, "binary", "application/octet-stream"}};

const Words& words_of(Form form) {
  return *std::find_if(kWords.begin(), kWords.end(),
                       [form](const Words& each) { return each.form == form; });
}

/// Takes the text up to a separator off the front, without blanks at its ends, in lower case.
std::string take(std::string_view& text, char separator) {
  std::string_view part = take_part(text, separator);
  while (!part.empty() && part.front() == ' ') part.remove_prefix(1);
  while (!part.empty() && part.back() == ' ') part.remove_suffix(1);
  std::string out(part);
  for (char& each : out) each = static_cast<char>(std::tolower(static_cast<unsigned char>(each)));
  return out;
}

/// The weight that a header Accept gives a media type, 0 to 1 (RFC 9110, 12.5.1): that of the most
/// specific range.
double weight(std::string_view accept, std::string_view media_type) {
  const std::string of_kind = std::string(media_type.substr(0, media_type.find('/'))) + "/*";
  int best = 0;
  double out = 0;
  while (!accept.empty()) {
    std::string element = take(accept, ',');
    std::string_view rest = element;
    const std::string range = take(rest, ';');
    double q = 1;
    while (!rest.empty()) {
      const std::string parameter = take(rest, ';');
      if (!parameter.starts_with("q=")) continue;
      if (std::from_chars(parameter.data() + 2, parameter.data() + parameter.size(), q).ec !=
          std::errc()) {
        q = 0;
      }
    }
    const int match = range == media_type ? 3 : range == of_kind ? 2 : range == "*/*" ? 1 : 0;
    if (match > best) {
      best = match;
      out = q;
    }
  }
  return out;
}

std::string list_of(const std::vector<Form>& offered, std::string_view Words::*word) {
  std::string out;
  for (const Form each : offered) {
    out += (out.empty() ? "" : ", ") + std::string(words_of(each).*word);
  }
  return out;
}

}  // namespace

std::string content_type(Form form) {
  const std::string_view type = words_of(form).media_type;
  const bool is_text = type.starts_with("text/") || type.ends_with("json");
  return std::string(type) + (is_text ? "; charset=utf-8" : "");
}

std::string_view form_word(Form form) { return words_of(form).word; }

std::optional<std::string_view> query_value(std::string_view target, std::string_view name) {
  const std::size_t question = target.find('?');
  std::string_view query = question == std::string_view::npos ? "" : target.substr(question + 1);
  while (!query.empty()) {
    const std::string_view pair = take_part(query, '&');
    if (pair.starts_with(name) && pair.substr(name.size()).starts_with('=')) {
      return pair.substr(name.size() + 1);
    }
  }
  return std::nullopt;
}

std::optional<Form> requested_form(const HttpRequest& request, const std::vector<Form>& offered,
                                   HttpResponse& refusal) {
  if (const auto word = query_value(request.target, kFormParameter)) {
    for (const Form each : offered) {
      if (words_of(each).word == *word) return each;
    }
    refusal = http_error(
        400, "alt is \"" + plain_excerpt(*word) + "\"; allowed: " + list_of(offered, &Words::word));
    return std::nullopt;
  }
  const std::string_view accept = request.header("accept");
  if (accept.empty()) return offered.front();
  std::optional<Form> out;
  double best = 0;
  for (const Form each : offered) {
    const double wish = weight(accept, words_of(each).media_type);
    if (wish <= best) continue;
    best = wish;
    out = each;
  }
  if (!out) {
    refusal = http_error(406, "Accept is \"" + plain_excerpt(accept) + "\"; this method answers " +
                                  list_of(offered, &Words::media_type));
  }
  return out;
}

}  // namespace tribodyn::server
