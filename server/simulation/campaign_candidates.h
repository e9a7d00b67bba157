#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "server/contract/resource_names.h"
#include "server/contract/violations.h"
#include "tribodyn/v1/campaigns.pb.h"

namespace tribodyn::server {

inline constexpr int kMaximumCandidates = 100'000;
/// Of the columns and attributes of all candidates [bytes]: 30 columns take 24 MB. An answer with
/// the view FULL holds them.
inline constexpr std::size_t kMaximumCandidateBytes = 32 << 20;
/// Largest number of lubricants that are candidates. Reading them takes half a second.
inline constexpr int kMaximumCandidateLubricants = 5000;

/// Returns the revisions of the lubricants that satisfy a filter, by name. Adds a violation at
/// "filter" if it cannot be read; it need not return more than kMaximumCandidateLubricants + 1.
using LubricantSearch =
    std::function<std::vector<std::string>(const std::string& filter, Violations& violations)>;

/// Returns true if the server makes the columns of the candidates.
bool has_made_columns(const v1::Campaign& requested);
/// Returns true if the candidates are lubricants.
bool has_lubricants(const v1::Campaign& requested, const v1::Campaign& table);
/// Returns true if the server makes the attribute where candidates are lubricants.
bool is_made_attribute(const std::string& name);

/// Replaces the attributes of a table of candidates, but for those that the server made. Adds a
/// violation for each new one that has the name of such an attribute.
void replace_attributes(
    const google::protobuf::RepeatedPtrField<v1::CandidateAttribute>& attributes,
    v1::Campaign& table, Violations& violations);

/// Leaves the first candidates in a table of at least as many.
void keep_first_candidates(int count, v1::Campaign& table);

/// Makes columns and attributes of the candidates of a request that states a design, lubricants or
/// a filter, and sets what follows from them: the base, the revisions of the lubricants, the
/// version of the design. Adds all violations; their paths are those of the campaign.
void make_candidates(v1::Campaign& request, const ResourceLookup& lookup,
                     const LubricantSearch& search, Violations& violations);

/// Returns the columns and attributes of lubricants, and their revisions, as the candidates of a
/// campaign whose base is `base`. Adds a violation at candidate_lubricants[i] for each that does
/// not exist or follows another law of viscosity under pressure.
v1::Campaign lubricant_candidates(const google::protobuf::RepeatedPtrField<std::string>& lubricants,
                                  const v1::Lubricant& base, const ResourceLookup& lookup,
                                  Violations& violations);

}  // namespace tribodyn::server
