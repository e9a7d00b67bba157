#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "server/storage/times.h"

namespace tribodyn::server {

/// Value of a property. Integers are times [us since 1970]. Values are compared only with values of
/// the same kind.
using PropertyValue = std::variant<std::int64_t, double, std::string>;

/// A value by which lists can be filtered and ordered.
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
  kFlag,  ///< stored as the integers 0 and 1
};

/// A field by which a collection can be filtered and ordered. Every collection also has "name" and
/// "labels.KEY".
struct PropertyField {
  std::string key;
  PropertyKind kind;
};

/// Returns create_time, update_time, and every singular text (except the description), enum and
/// number of the collection's message that a client may set. Empty for an unknown collection.
const std::vector<PropertyField>& property_fields(std::string_view collection);

/// Returns the properties of a serialised resource: one for each field of property_fields(), and
/// "labels.KEY" for each label. An unset text is empty, an unset enum is the name of its zero, an
/// unset number is left out. Empty if the collection is unknown or the body cannot be parsed.
std::vector<Property> properties_of(std::string_view collection, const std::string& body,
                                    Microseconds create_time, Microseconds update_time);

}  // namespace tribodyn::server
