#include "core/lubricant/base_oil.h"

#include <iterator>

namespace tribodyn {

const char* name(BaseOilClass base_oil) {
  static constexpr const char* kNames[] = {
      "unspecified",         "group I",    "group II", "group III", "polyalphaolefin", "ester",
      "polyalkylene glycol", "naphthenic",
  };
  static_assert(std::size(kNames) == kBaseOilClasses);
  return kNames[static_cast<int>(base_oil)];
}

}  // namespace tribodyn
