#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "google/rpc/status.pb.h"
#include "server/transport/http/http_message.h"

namespace tribodyn::server {

/// A form of an answer.
enum class Form {
  kMessage,  ///< one message in protobuf's JSON
  kEvents,   ///< server-sent events
  kLines,    ///< messages as JSON lines
  kColumns,  ///< columns in JSON
  /// The same of a method that also answers kMessage: a media type of its own tells the two apart.
  kPointColumns,
  kCsv,     ///< columns as a table with a header line
  kNumpy,   ///< columns as a structured array in a .npy file
  kBinary,  ///< columns of little-endian doubles after a JSON header
};

/// Returns the form that a client asks for: the query parameter "alt", else the header Accept. The
/// first of `offered` if the client has no wish. Returns nullopt, and an error that lists the
/// forms, if the client wants none of them.
std::optional<Form> requested_form(const HttpRequest& request, const std::vector<Form>& offered,
                                   HttpResponse& refusal);

/// Returns the value of the header Content-Type for a form.
std::string content_type(Form form);
/// Returns the word of the query parameter that chooses a form, e.g. "csv".
std::string_view form_word(Form form);

/// Returns the first value of a query parameter without decoding it, or nullopt.
std::optional<std::string_view> query_value(std::string_view target, std::string_view name);

inline constexpr std::string_view kFormParameter = "alt";

}  // namespace tribodyn::server
