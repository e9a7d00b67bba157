#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "server/storage/stored_resource.h"

namespace tribodyn::server {

/// A figure that the server computes from the data of a lubricant (LubricantCharacterisation).
/// Filters and orders of lists use it like a stored property. The server computes it for each list,
/// so that it always agrees with the figures in the list.
struct ComputedField {
  std::string key;                            ///< field of LubricantCharacterisation
  PropertyKind kind;                          ///< a number or a text
  std::vector<std::string_view> short_names;  ///< names on data sheets, e.g. "kv40"
};

/// Returns the computed fields of a collection. Only lubricants have any.
const std::vector<ComputedField>& computed_fields(std::string_view collection);

/// Returns the field with this key or short name; null if there is none.
const ComputedField* find_computed_field(std::string_view collection, std::string_view name);

/// Returns the value of one row by which its list is ordered; `key` is ResourceQuery::order_key.
PropertyValue order_value(const StoredResource& resource, const std::string& key);

/// Returns a page of a query that restricts or orders by computed fields. Reads the resources that
/// satisfy the other restrictions, kRowsAtATime at a time.
Page<StoredResource> query_by_computed_fields(
    const ResourceQuery& query,
    const std::function<Page<StoredResource>(const ResourceQuery&)>& read_page);

inline constexpr int kRowsAtATime = 1000;

/// Returns true if a query needs query_by_computed_fields().
bool needs_computed_fields(const ResourceQuery& query);

}  // namespace tribodyn::server
