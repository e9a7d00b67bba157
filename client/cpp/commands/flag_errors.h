#pragma once

#include <map>
#include <string>
#include <vector>

#include "client/cpp/commands/flags.h"
#include "tribodyn/client/error.h"

namespace tribodyn::client {

/// A flag in the user's spelling.
struct TypedFlag {
  std::string name;                ///< the spelling that was typed: "--density15"
  std::vector<std::string> texts;  ///< its values
  std::string bare_unit;           ///< the unit of a number that has none
};

/// The flags of a command line by the field of the request that each sets.
using TypedFlags = std::map<std::string, TypedFlag>;

/// The refusal with the flags that were typed in place of the fields that they set. Where the
/// number is allowed in another unit of its kind, it says how to write it: "--density15 = 0.895
/// kg/m3; allowed: 500 to 2000 kg/m3 (eq 26); 0.895 looks like g/cm3: write 0.895g/cm3 or 895".
ServiceError with_flag_names(const ServiceError& error, const TypedFlags& typed);

/// The complaints with each flag as it was typed.
void name_flags_as_typed(const std::vector<std::string>& arguments,
                         const std::vector<const FlagList*>& lists, Complaints& complaints);

/// The spelling of a flag that stands on the command line; its first name when none does.
std::string typed_name(const Flag& flag, const std::vector<std::string>& arguments);

}  // namespace tribodyn::client
