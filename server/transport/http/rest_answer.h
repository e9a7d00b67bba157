#pragma once

#include <google/protobuf/message.h>

#include <string>
#include <string_view>

#include "google/rpc/status.pb.h"
#include "server/transport/http/http_message.h"

namespace tribodyn::server {

/// Returns the HTTP status of a google.rpc code (AIP-193); 412 for an etag that has changed.
int http_status(const google::rpc::Status& error);

/// Returns the error as JSON: {"error": {"code", "message", "status", "details"}}. With Retry-After
/// [s, rounded up] if the error has RetryInfo.
HttpResponse error_response(const google::rpc::Status& error);
/// The same with another HTTP status, for errors of HTTP itself.
HttpResponse error_response(const google::rpc::Status& error, int status);
/// A request that is no HTTP which the server serves: INVALID_HTTP.
HttpResponse http_error(int status, const std::string& message);

/// Returns the message in JSON without line breaks: names in snake_case, 64-bit integers as texts,
/// "NaN" and "Infinity". Throws std::logic_error.
std::string json_of(const google::protobuf::Message& message, bool with_zeros);

/// Returns the message as JSON. `with_zeros` is false if the request has a read_mask: a zero of a
/// field that the mask leaves out would read as the field's value. With ETag: the message's own
/// etag, else a hash of the body. Status 304 without a body if `request` is a GET or HEAD that has
/// this tag already.
HttpResponse message_response(const google::protobuf::Message& message, const HttpRequest& request,
                              bool with_zeros);

/// Gives the response an ETag. Makes it 304 without a body if `request` is a GET or HEAD that has
/// this tag already.
void set_etag(const std::string& tag, const HttpRequest& request, HttpResponse& response);

/// True if the header Accept-Encoding allows gzip.
bool accepts_gzip(std::string_view header);

/// Compresses the body, unless it is compressed already or a range, if the header Accept-Encoding
/// allows gzip and the body is long enough to gain.
void compress(std::string_view accept_encoding, HttpResponse& response);

}  // namespace tribodyn::server
