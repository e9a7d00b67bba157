#pragma once

#include <string>

#include "core/refusal.h"

namespace tribodyn {

/// Returns "REASON: sentence" of the Refusal that a call throws, or "none".
template <class Call>
std::string refusal_of(Call&& call) {
  try {
    call();
  } catch (const Refusal& refusal) {
    return refusal.reason() + ": " + refusal.what();
  }
  return "none";
}

/// Returns only the reason.
template <class Call>
std::string refusal_reason(Call&& call) {
  const std::string text = refusal_of(call);
  return text.substr(0, text.find(':'));
}

}  // namespace tribodyn
