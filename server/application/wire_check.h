#pragma once

#include <google/protobuf/descriptor.h>
#include <google/protobuf/io/zero_copy_stream.h>

#include "server/contract/violations.h"

namespace tribodyn::server {

/// Checks a serialised request of `size` bytes before it is parsed, because a parsed message can be
/// much larger: an empty FlankSlot takes 2 bytes on the wire and 348 times as much in memory.
/// Counts the elements of every list, at any depth, also of messages that the wire holds in several
/// parts. Adds a violation with its path for each list that is longer than in any acceptable
/// request (element_limits.h), for too many unknown fields and for too many elements in total. Adds
/// one violation without a path if the bytes are not such a message; parsing finds the remaining
/// defects. Time grows with the bytes, memory only with the limits.
void check_wire(google::protobuf::io::ZeroCopyInputStream& bytes, int size,
                const google::protobuf::Descriptor& type, Violations& violations);

/// Returns the violation for bytes that are not a message of this type.
Violation unreadable_violation(const google::protobuf::Descriptor& type);

}  // namespace tribodyn::server
