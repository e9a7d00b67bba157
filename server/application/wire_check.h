#pragma once

#include <google/protobuf/descriptor.h>
#include <google/protobuf/io/zero_copy_stream.h>

#include "server/contract/violations.h"

namespace tribodyn::server {

/// Checks a serialised request of `size` bytes before it is parsed, as parsing may multiply its
/// size: an empty FlankSlot takes 2 bytes on the wire and 348 times as much in memory. Counts the
/// elements of every list, at any depth and over all parts of a message that the wire holds in
/// parts, and adds a violation, with its path, for each list that has more than any acceptable
/// request (element_limits.h), and for unknown fields and for elements in all. Bytes that are no
/// such message are one violation without a path; what this function does not find, parsing does.
/// Takes time in proportion to the bytes and memory in proportion to what is acceptable.
void check_wire(google::protobuf::io::ZeroCopyInputStream& bytes, int size,
                const google::protobuf::Descriptor& type, Violations& violations);

/// The violation of bytes that are no message of this type.
Violation unreadable_violation(const google::protobuf::Descriptor& type);

}  // namespace tribodyn::server
