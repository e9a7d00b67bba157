#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "server/contract/violations.h"
#include "server/storage/stored_resource.h"

namespace tribodyn::server {

/// Parses an AIP-160 filter: conditions `field operator value` joined by AND.
///   fields     "name", property_fields(), computed_fields(), "labels.KEY"
///   operators  = != < <= > >=, ":" (a text contains the value), ":*" (the field is set)
///   values     words, or texts in double quotes with \" and \\; numbers as in C, times as in RFC
///              3339, enums by name in upper or lower case, names of resources with or without
///              their collection
/// Adds every violation at "filter"; that of an unknown word has the nearest known word.
std::vector<Restriction> parse_filter(std::string_view filter, const std::string& collection,
                                      Violations& violations);

/// Parses a filter on a list of simulations or campaigns, whose conditions are of the table's
/// columns: the value of a state is its number. Adds a violation for a comparison that a column
/// does not have.
std::vector<Restriction> parse_job_filter(std::string_view filter, const std::string& collection,
                                          Violations& violations);

/// A condition of a filter as it stands there.
struct FilterCondition {
  std::string field;
  Restriction::Comparison comparison = Restriction::Comparison::kEqual;
  std::string value;
  bool is_quoted = false;
};

/// Splits a filter whose fields are not those of a collection. Adds a violation at "filter" if it
/// has another form; `example`: a filter that the violation quotes.
std::vector<FilterCondition> split_filter(std::string_view filter, const std::string& example,
                                          Violations& violations);

/// Returns a finite number as in C; nullopt if the text is none.
std::optional<double> filter_number(std::string_view text);

struct Order {
  std::string key;  ///< empty: by name
  bool descending = false;
};

/// Parses an order: "name" or a field of property_fields() or computed_fields(), optionally
/// followed by "asc" or "desc". Empty means by name. Adds violations at "order_by".
Order parse_order(std::string_view order_by, const std::string& collection, Violations& violations);

/// Returns the names that a filter may use, sorted; "labels.KEY" stands for all labels.
std::vector<std::string> filter_fields(const std::string& collection);

inline constexpr std::size_t kMaximumFilterLength = 2000;  ///< [bytes]
inline constexpr std::size_t kMaximumRestrictions = 20;

}  // namespace tribodyn::server
