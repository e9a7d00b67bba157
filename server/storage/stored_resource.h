#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "server/storage/properties.h"
#include "server/storage/times.h"

namespace tribodyn::server {

/// Part of a list, and whether there is more after it.
template <class Row>
struct Page {
  std::vector<Row> rows;
  bool more = false;
};

/// A resource to be stored.
struct NewResource {
  std::string name;
  std::string body;  ///< serialised message
};

/// One revision of a resource.
struct StoredResource {
  std::int64_t id = 0;  ///< of the resource
  std::string name;
  int revision = 0;
  bool is_present = true;  ///< the newest revision
  Microseconds create_time = 0;
  Microseconds revision_create_time = 0;
  std::optional<Microseconds> delete_time;
  std::string content_hash;
  std::string body;  ///< serialised message
};

/// A new resource, or the next revision of one.
struct ResourceWrite {
  NewResource resource;
  std::optional<StoredResource> present;  ///< as it was read; none: the resource is new
};

/// One condition of a filter. Text is compared as bytes, "contains" without regard to the case of
/// ASCII letters.
struct Restriction {
  enum class Comparison {
    kEqual,
    kNotEqual,  ///< also true of a resource that has no such property
    kLess,
    kLessOrEqual,
    kGreater,
    kGreaterOrEqual,
    kContains,
    kPresent,  ///< has the property, whatever its value
  };
  std::string key;  ///< "name", or of Property
  Comparison comparison = Comparison::kEqual;
  PropertyValue value;
};

/// Where a page begins: after the resource of this name and, when ordered by a property, value.
struct PageStart {
  PropertyValue value;
  std::string name;
};

struct ResourceQuery {
  std::string collection;
  std::vector<Restriction> restrictions;  ///< all of them hold
  std::string order_key;                  ///< empty: by name
  bool descending = false;
  bool show_deleted = false;
  std::optional<PageStart> after;
  int limit = 0;
  std::size_t byte_limit = 0;  ///< of bodies; a page holds at least one row
};

}  // namespace tribodyn::server
