#pragma once

namespace tribodyn {

/// API 1509 annex E groups I to V, V split up, naphthenic oils apart.
enum class BaseOilClass {
  kUnspecified,
  kGroupI,              ///< solvent-refined paraffinic mineral oil
  kGroupII,             ///< hydrotreated mineral oil
  kGroupIII,            ///< severely hydrotreated or gas-to-liquid, VI >= 120
  kPolyalphaolefin,     ///< group IV
  kEster,               ///< group V
  kPolyalkyleneGlycol,  ///< group V
  kNaphthenic,          ///< group V, VI below 80
};
inline constexpr int kBaseOilClasses = static_cast<int>(BaseOilClass::kNaphthenic) + 1;

/// "group I", "polyalphaolefin", ...
const char* name(BaseOilClass base_oil);

}  // namespace tribodyn
