#pragma once

namespace tribodyn::server {

/// Redirects the reports of libprotobuf from standard error to the server's log. Bad requests cause
/// reports, so the log takes one a second and states the number of the others.
void log_protobuf_reports();

}  // namespace tribodyn::server
