#pragma once

#include <google/protobuf/descriptor.h>

#include <string>
#include <vector>

#include "client/cpp/text/flags.h"
#include "core/decisions/design.h"
#include "tribodyn/v1/campaigns.pb.h"

namespace tribodyn::client {

/// One parameter of a design.
struct DesignFactor {
  const google::protobuf::FieldDescriptor* field;
  FactorRange range;  ///< in the unit of the field
};

enum class DesignMethod { kSobol, kLatinHypercube, kGrid };

/// A design as flags state it.
struct DesignFlags {
  std::vector<DesignFactor> factors;
  bool has_ranges = false;  ///< also of ranges that cannot be read
  bool has_method = false;  ///< one of the flags of add_method_flags() is given
  DesignMethod method = DesignMethod::kSobol;
  int count = 0;   ///< 0: default
  int levels = 0;  ///< 0: default
  int seed = 1;

  int count_or_default() const { return count == 0 ? 64 : count; }
  int levels_or_default() const { return levels == 0 ? 3 : levels; }
};

/// Adds --range and --log-range.
void add_range_flags(FlagList& list, DesignFlags& flags);
/// Adds --method, --count, --levels and --seed; `most`: largest number of candidates.
void add_method_flags(FlagList& list, int most, DesignFlags& flags);
void check_design_flags(const DesignFlags& flags, int most, Complaints& complaints);

/// Returns the design as the server makes it. Without ranges it follows the standard uncertainties
/// of its base.
v1::CandidateDesign design_message(const DesignFlags& flags);

}  // namespace tribodyn::client
