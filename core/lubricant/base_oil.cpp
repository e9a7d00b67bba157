#include "core/lubricant/base_oil.h"

namespace tribodyn {

const char* name(BaseOilClass base_oil) {
  switch (base_oil) {
    case BaseOilClass::kGroupI:
      return "group I";
    case BaseOilClass::kGroupII:
      return "group II";
    case BaseOilClass::kGroupIII:
      return "group III";
    case BaseOilClass::kPolyalphaolefin:
      return "polyalphaolefin";
    case BaseOilClass::kEster:
      return "ester";
    case BaseOilClass::kPolyalkyleneGlycol:
      return "polyalkylene glycol";
    case BaseOilClass::kNaphthenic:
      return "naphthenic";
    case BaseOilClass::kUnspecified:
      break;
  }
  return "unspecified";
}

}  // namespace tribodyn
