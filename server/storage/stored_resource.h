#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "server/contract/resource_names.h"
#include "server/storage/properties.h"
#include "server/storage/times.h"

namespace tribodyn::server {

inline constexpr std::int64_t kNotCounted = -1;

/// A page of a list; `more` is true if the list continues after it.
template <class Row>
struct Page {
  std::vector<Row> rows;
  bool more = false;
  std::int64_t total = 0;  ///< rows of the whole list, or kNotCounted; only if the query asked
};

/// A resource before it is stored.
struct NewResource {
  std::string name;  ///< full name
  std::string body;  ///< serialised message, whose name is the relative one
};

/// One revision of a resource.
struct StoredResource {
  std::int64_t id = 0;  ///< id of the resource
  std::string name;     ///< full name
  int revision = 0;
  bool is_present = true;  ///< true for the latest revision
  Microseconds create_time = 0;
  Microseconds revision_create_time = 0;
  std::optional<Microseconds> delete_time;
  std::string content_hash;
  std::string body;  ///< serialised message
};

/// The revisions of the resources of a simulation or of a campaign, as relative names, e.g.
/// "lubricants/paper-fluid-1@2"; empty without such a resource, and if it is unknown.
struct ResourceRevisions {
  std::string lubricant = {};
  std::string gear_set = {};
  std::string surface = {};
  std::string vehicle = {};

  std::array<const std::string*, 4> all() const {
    return {&lubricant, &gear_set, &surface, &vehicle};
  }
};

/// A new resource, or the next revision of one.
struct ResourceWrite {
  NewResource resource;
  std::optional<StoredResource> present;  ///< resource as it was read; nullopt: the resource is new
};

/// One condition of a filter. Texts are compared as bytes; "contains" ignores the case of ASCII
/// letters.
struct Restriction {
  enum class Comparison {
    kEqual,
    kNotEqual,  ///< also true for a resource without the property
    kLess,
    kLessOrEqual,
    kGreater,
    kGreaterOrEqual,
    kContains,
    kPresent,  ///< true for every value of the property
  };
  std::string key;  ///< "name" or the key of a Property
  Comparison comparison = Comparison::kEqual;
  PropertyValue value;
};

/// Start of a page: after the resource with this full name and, if ordered by a property, with this
/// value.
struct PageStart {
  PropertyValue value;
  std::string name;
};

struct ResourceQuery {
  std::string project = kDefaultProject;
  std::string collection;                 ///< without the project
  std::vector<Restriction> restrictions;  ///< all must be true
  std::string order_key;                  ///< empty: order by name
  bool descending = false;
  bool show_deleted = false;
  std::optional<PageStart> after;
  int limit = 0;
  std::size_t byte_limit = 0;  ///< bytes of bodies; a page has at least one row
  bool counts_all = false;  ///< sets Page::total; only of a query from the start, without `after`
};

}  // namespace tribodyn::server
