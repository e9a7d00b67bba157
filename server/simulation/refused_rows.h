#pragma once

#include <google/protobuf/repeated_field.h>

#include <map>
#include <string>
#include <utility>

#include "tribodyn/v1/points.pb.h"

namespace tribodyn::server {

/// Numbers the refusals of rows: each reason and sentence once, from 1.
class RefusedRows {
 public:
  /// Sets the numbers of all rows to 0. The fields must outlive this object.
  RefusedRows(int rows, google::protobuf::RepeatedField<std::int32_t>& numbers,
              google::protobuf::RepeatedPtrField<v1::PointRefusal>& refusals)
      : numbers_(numbers), refusals_(refusals) {
    numbers_.Resize(rows, 0);
  }

  void add(int row, const std::string& reason, const std::string& message) {
    const auto [at, is_new] =
        known_.emplace(std::pair(reason, message), static_cast<int>(known_.size()) + 1);
    if (is_new) {
      v1::PointRefusal& refusal = *refusals_.Add();
      refusal.set_reason(reason);
      refusal.set_message(message);
    }
    numbers_.Set(row, at->second);
  }

 private:
  google::protobuf::RepeatedField<std::int32_t>& numbers_;
  google::protobuf::RepeatedPtrField<v1::PointRefusal>& refusals_;
  std::map<std::pair<std::string, std::string>, int> known_;
};

}  // namespace tribodyn::server
