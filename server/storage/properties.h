#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "server/storage/times.h"

namespace tribodyn::server {

/// Compared within its kind: whole numbers are times [us since 1970].
using PropertyValue = std::variant<std::int64_t, double, std::string>;

/// One value that lists can be filtered and ordered by.
struct Property {
  std::string key;
  PropertyValue value;
  friend bool operator==(const Property&, const Property&) = default;
};

enum class PropertyKind {
  kText,
  kNumber,
  kEnum,
  kTime,
  kFlag,  ///< stored as the whole numbers 0 and 1
};

/// What a collection can be filtered and ordered by, besides "name" and "labels.KEY".
struct PropertyField {
  std::string key;
  PropertyKind kind;
};

/// create_time and update_time, and every singular text but the description, enum and number of the
/// collection's message that a client may set. Empty for an unknown collection.
const std::vector<PropertyField>& property_fields(std::string_view collection);

/// The values of a serialised resource: one for every field above, texts empty and enums by name
/// when unset (unset numbers are left out), and "labels.KEY" for every label. Empty for an unknown
/// collection or what does not parse.
std::vector<Property> properties_of(std::string_view collection, const std::string& body,
                                    Microseconds create_time, Microseconds update_time);

}  // namespace tribodyn::server
