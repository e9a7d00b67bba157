#pragma once

#include <map>
#include <string>
#include <vector>

#include "client/cpp/text/flags.h"
#include "tribodyn/client/error.h"

namespace tribodyn::client {

/// A flag as the user typed it.
struct TypedFlag {
  std::string name;                ///< e.g. "--density15"; NAME of a positional
  std::vector<std::string> texts;  ///< its values
  std::string bare_unit;           ///< unit of a number without one
};

/// The typed flags, by the field of the request that each sets.
using TypedFlags = std::map<std::string, TypedFlag>;

/// Returns the error with the typed flags in place of the fields that they set. If the number is in
/// the allowed range when read in another unit, the message adds how to write it: "--density15 =
/// 0.895 kg/m3; allowed: 500 to 2000 kg/m3 (eq 26); 0.895 looks like g/cm3: write 0.895g/cm3 or
/// 895".
ServiceError with_flag_names(const ServiceError& error, const TypedFlags& typed);

/// Replaces flags in the complaints by the names that the user typed.
void name_flags_as_typed(const std::vector<std::string>& arguments,
                         const std::vector<const FlagList*>& lists, Complaints& complaints);

/// Returns the name of the flag that the command line contains; its first name if there is none.
std::string typed_name(const Flag& flag, const std::vector<std::string>& arguments);

}  // namespace tribodyn::client
