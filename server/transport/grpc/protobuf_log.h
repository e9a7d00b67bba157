#pragma once

namespace tribodyn::server {

/// Sends what libprotobuf reports, by itself on standard error, to the server's log: bad requests
/// make it report, so the log takes a line a second and counts the others.
void log_protobuf_reports();

}  // namespace tribodyn::server
