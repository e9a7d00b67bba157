#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "server/contract/violations.h"
#include "server/storage/stored_resource.h"

namespace tribodyn::server {

/// The restrictions of an AIP-160 filter: `field operator value` joined by AND. Fields: name, those
/// of property_fields and computed_fields, labels.KEY; operators = != < <= > >= and ":" (texts:
/// contains; ":*": is there). A value is a word or stands in double quotes with \" and \\; numbers
/// as in C, times as in RFC 3339, enums by name in either case, names of resources with or without
/// their collection. Adds every violation at "filter"; unknown words name the nearest.
std::vector<Restriction> parse_filter(std::string_view filter, const std::string& collection,
                                      Violations& violations);

struct Order {
  std::string key;  ///< empty: by name
  bool descending = false;
};

/// "name", a field of property_fields or computed_fields, either followed by "desc" or "asc";
/// empty: by name.
Order parse_order(std::string_view order_by, const std::string& collection, Violations& violations);

/// Names that a filter may use, sorted; "labels.KEY" stands for all labels.
std::vector<std::string> filter_fields(const std::string& collection);

inline constexpr std::size_t kMaximumFilterLength = 2000;  ///< bytes
inline constexpr std::size_t kMaximumRestrictions = 20;

}  // namespace tribodyn::server
