#pragma once

namespace tribodyn {

/// Digits of exponentials and logarithms of packs: kFull is within 2 units in the last place, kHalf
/// within 2e-8. Other numbers always have all digits.
enum class Digits { kFull, kHalf };

}  // namespace tribodyn
