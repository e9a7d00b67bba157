#include "server/simulation/row_warnings.h"

#include "server/mapping/from_core.h"

namespace tribodyn::server {

void RowWarnings::add(int row, const std::vector<RangeWarning>& warnings,
                      google::protobuf::RepeatedPtrField<v1::PointWarning>& out) {
  for (const RangeWarning& each : warnings) {
    const auto [at, is_new] = known_.try_emplace(each.code, Furthest{out.size(), each.excess});
    if (is_new) {
      out.Add()->set_code(each.code);
      set_kind(out[at->second.position]);
    }
    v1::PointWarning& warning = out[at->second.position];
    if (is_new || each.excess > at->second.excess) {
      at->second.excess = each.excess;
      warning.set_message(each.sentence);
    }
    warning.add_rows(row);
  }
}

}  // namespace tribodyn::server
