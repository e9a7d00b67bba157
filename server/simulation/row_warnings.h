#pragma once

#include <map>
#include <string>
#include <vector>

#include "core/study/point_result.h"
#include "tribodyn/v1/points.pb.h"

namespace tribodyn::server {

/// The warnings of rows: one for each code, with its rows and the sentence of the row that is
/// furthest outside the range.
class RowWarnings {
 public:
  void add(int row, const std::vector<RangeWarning>& warnings,
           google::protobuf::RepeatedPtrField<v1::PointWarning>& out);

 private:
  struct Furthest {
    int position;
    double excess;
  };
  std::map<std::string, Furthest> known_;  // by code
};

}  // namespace tribodyn::server
