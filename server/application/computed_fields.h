#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "server/storage/stored_resource.h"

namespace tribodyn::server {

/// A figure that the server computes from what a lubricant states (LubricantCharacterisation).
/// Lists are filtered and ordered by it as by a stored property, but it is computed when it is
/// asked for: so it always agrees with what the list shows.
struct ComputedField {
  std::string key;                            ///< of LubricantCharacterisation
  PropertyKind kind;                          ///< a number or a text
  std::vector<std::string_view> short_names;  ///< of the trade: "kv40"
};

/// Those of a collection; only lubricants have any.
const std::vector<ComputedField>& computed_fields(std::string_view collection);

/// The field of this key or short name; null if there is none.
const ComputedField* find_computed_field(std::string_view collection, std::string_view name);

/// The value by which a list is ordered, of one of its rows; `key` as in ResourceQuery.
PropertyValue order_value(const StoredResource& resource, const std::string& key);

/// A page of a query of which some restrictions, or the order, are about computed fields. Reads the
/// resources that satisfy the other restrictions, kRowsAtATime at a time.
Page<StoredResource> query_by_computed_fields(
    const ResourceQuery& query,
    const std::function<Page<StoredResource>(const ResourceQuery&)>& read_page);

inline constexpr int kRowsAtATime = 1000;

/// Whether query_by_computed_fields has to answer a query.
bool needs_computed_fields(const ResourceQuery& query);

}  // namespace tribodyn::server
