#pragma once

#include <cstddef>
#include <type_traits>
#include <utility>

namespace tribodyn::server {

/// Returns the value beside `key` in a table of pairs; `otherwise` if the table has no such key.
template <class Key, class Value, std::size_t size>
constexpr Value value_of(const std::pair<Key, Value> (&table)[size], Key key,
                         std::type_identity_t<Value> otherwise) {
  for (const auto& [each, value] : table) {
    if (each == key) return value;
  }
  return otherwise;
}

}  // namespace tribodyn::server
