#pragma once

#include <google/protobuf/field_mask.pb.h>
#include <google/protobuf/message.h>

#include <map>
#include <string_view>

#include "server/contract/violations.h"

namespace tribodyn::server {

/// Which fields of an answer a request asks for (AIP-157). A path names a field at any depth and
/// goes through lists: "labels", "measurements.densities",
/// "result.points.result.mesh_frequency_hertz". An omitted mask and "*" ask for every field.
class ReadMask {
 public:
  /// Asks for every field.
  ReadMask() = default;
  /// Paths that lead to no field of `answer` become violations at "read_mask", with the nearest
  /// known name. A mask of more than kMaximumMaskPaths paths is refused whole.
  ReadMask(const google::protobuf::FieldMask& mask, const google::protobuf::Descriptor& answer,
           Violations& violations);

  /// Returns true if the mask asks for every field.
  bool is_whole() const { return root_.parts.empty(); }

  /// Returns true if the mask asks for the field of this name at the top, or for a part of it.
  bool asks_for(std::string_view field) const;

  /// Clears the fields of `answer` that the mask does not ask for.
  void apply(google::protobuf::Message& answer) const;

 private:
  struct Node {
    std::map<const google::protobuf::FieldDescriptor*, Node> parts;  ///< empty: the whole field
  };
  static void clear_others(const Node& node, google::protobuf::Message& message);

  Node root_;
};

}  // namespace tribodyn::server
