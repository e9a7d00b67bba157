#include "server/application/computed_fields.h"

#include <google/protobuf/descriptor.h>

#include <algorithm>
#include <cctype>
#include <tuple>
#include <utility>

#include "server/contract/resource_names.h"
#include "server/resources/lubricant_parameters.h"
#include "server/storage/properties.h"
#include "server/storage/resource_types.h"

namespace tribodyn::server {
namespace {

using Comparison = Restriction::Comparison;

std::string lower_case(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

bool is_computed(const std::string& collection, const std::string& key) {
  return find_computed_field(collection, key) != nullptr;
}

/// Returns the computed figures of a stored lubricant; none if its body cannot be parsed.
v1::LubricantCharacterisation figures_of(const StoredResource& resource) {
  v1::Lubricant lubricant;
  if (!lubricant.ParseFromString(resource.body)) return {};
  return brief_characterisation(lubricant);
}

/// Returns one figure, or nullopt if the lubricant has none, e.g. where a viscosity index is
/// undefined.
std::optional<PropertyValue> figure(const v1::LubricantCharacterisation& figures,
                                    const std::string& key) {
  const auto* field = v1::LubricantCharacterisation::descriptor()->FindFieldByName(key);
  const auto& reflection = *figures.GetReflection();
  if (field->cpp_type() == google::protobuf::FieldDescriptor::CPPTYPE_STRING) {
    return reflection.GetString(figures, field);
  }
  const double value = reflection.GetDouble(figures, field);
  const bool is_known = field->has_presence() ? reflection.HasField(figures, field) : value != 0;
  return is_known ? std::optional<PropertyValue>(value) : std::nullopt;
}

/// Compares like the store compares a stored property.
bool is_satisfied(const std::optional<PropertyValue>& value, const Restriction& restriction) {
  if (restriction.comparison == Comparison::kNotEqual) return !value || *value != restriction.value;
  if (!value) return false;
  switch (restriction.comparison) {
    case Comparison::kEqual:
      return *value == restriction.value;
    case Comparison::kLess:
      return *value < restriction.value;
    case Comparison::kLessOrEqual:
      return *value <= restriction.value;
    case Comparison::kGreater:
      return *value > restriction.value;
    case Comparison::kGreaterOrEqual:
      return *value >= restriction.value;
    case Comparison::kContains:
      return lower_case(std::get<std::string>(*value))
                 .find(lower_case(std::get<std::string>(restriction.value))) != std::string::npos;
    default:
      return true;  // kPresent
  }
}

/// A resource with the value that orders it.
struct Ordered {
  PageStart place;
  StoredResource resource;
};

class ComputedQuery {
 public:
  ComputedQuery(const ResourceQuery& query,
                const std::function<Page<StoredResource>(const ResourceQuery&)>& read_page)
      : query_(query), stored_(query), read_page_(read_page) {
    stored_.limit = kRowsAtATime;
    stored_.counts_all = false;
    std::erase_if(stored_.restrictions, [&](const Restriction& each) {
      if (!is_computed(query.collection, each.key)) return false;
      computed_.push_back(each);
      return true;
    });
  }

  /// Answers a query that is ordered by a stored property. Stops reading when the page is full and
  /// so does not count the rest, which would take a second for 20,000 lubricants.
  Page<StoredResource> in_stored_order() {
    Page<StoredResource> out;
    std::size_t bytes = 0;
    for (;;) {
      const Page<StoredResource> page = read_page_(stored_);
      for (const StoredResource& row : page.rows) {
        if (!satisfies(figures_of(row))) continue;
        bytes += row.body.size();
        if (is_full(out.rows.size(), bytes)) {
          out.more = true;
          out.total = kNotCounted;
          return out;
        }
        out.rows.push_back(row);
        ++out.total;
      }
      if (!page.more) return out;
      go_on_after(page.rows.back());
    }
  }

  /// Answers a query that is ordered by a computed field: reads all rows and keeps the first ones
  /// after the start of the page.
  Page<StoredResource> in_computed_order() {
    stored_.order_key.clear();
    stored_.descending = false;
    stored_.after.reset();
    std::vector<Ordered> first;  // sorted, at most one more than the page holds
    std::int64_t total = 0;
    const auto limit = static_cast<std::size_t>(query_.limit) + 1;
    for (bool more = true; more;) {
      const Page<StoredResource> page = read_page_(stored_);
      for (const StoredResource& row : page.rows) {
        const v1::LubricantCharacterisation figures = figures_of(row);
        const auto value = figure(figures, query_.order_key);
        if (!value || !satisfies(figures)) continue;
        ++total;
        const PageStart place{*value, row.name};
        if (query_.after && !is_before(*query_.after, place)) continue;
        const auto at = std::upper_bound(
            first.begin(), first.end(), place,
            [&](const PageStart& a, const Ordered& b) { return is_before(a, b.place); });
        if (at == first.end() && first.size() == limit) continue;
        first.insert(at, Ordered{place, row});
        if (first.size() > limit) first.pop_back();
      }
      more = page.more;
      if (more) go_on_after(page.rows.back());
    }
    Page<StoredResource> out;
    out.total = total;
    std::size_t bytes = 0;
    for (Ordered& each : first) {
      bytes += each.resource.body.size();
      if (is_full(out.rows.size(), bytes)) {
        out.more = true;
        return out;
      }
      out.rows.push_back(std::move(each.resource));
    }
    return out;
  }

 private:
  bool satisfies(const v1::LubricantCharacterisation& figures) const {
    return std::all_of(computed_.begin(), computed_.end(), [&](const Restriction& each) {
      return is_satisfied(figure(figures, each.key), each);
    });
  }

  bool is_full(std::size_t rows, std::size_t bytes_with_next) const {
    return rows == static_cast<std::size_t>(query_.limit) ||
           (rows > 0 && bytes_with_next > query_.byte_limit);
  }

  /// Compares values, and names if the values are equal, in the direction of the query.
  bool is_before(const PageStart& a, const PageStart& b) const {
    const auto left = std::tie(a.value, a.name);
    const auto right = std::tie(b.value, b.name);
    return query_.descending ? right < left : left < right;
  }

  void go_on_after(const StoredResource& last) {
    stored_.after = PageStart{order_value(last, stored_.order_key), last.name};
  }

  const ResourceQuery& query_;
  ResourceQuery stored_;
  const std::function<Page<StoredResource>(const ResourceQuery&)>& read_page_;
  std::vector<Restriction> computed_;
};

}  // namespace

const std::vector<ComputedField>& computed_fields(std::string_view collection) {
  static const std::vector<ComputedField> kFields = {
      {"density_15_celsius_kilograms_per_cubic_metre",
       PropertyKind::kNumber,
       {"density", "density15"}},
      {"kinematic_viscosity_100_celsius_square_millimetres_per_second",
       PropertyKind::kNumber,
       {"kv100"}},
      {"kinematic_viscosity_40_celsius_square_millimetres_per_second",
       PropertyKind::kNumber,
       {"kv40"}},
      {"sae_j306_grade", PropertyKind::kText, {"sae_grade"}},
      {"viscosity_index", PropertyKind::kNumber, {"vi"}},
  };
  static const std::vector<ComputedField> kNone;
  return collection == kLubricants ? kFields : kNone;
}

const ComputedField* find_computed_field(std::string_view collection, std::string_view name) {
  for (const ComputedField& field : computed_fields(collection)) {
    const auto& names = field.short_names;
    if (field.key == name || std::find(names.begin(), names.end(), name) != names.end()) {
      return &field;
    }
  }
  return nullptr;
}

PropertyValue order_value(const StoredResource& resource, const std::string& key) {
  if (key.empty()) return std::string();
  const std::string collection = collection_of(resource.name);
  if (is_computed(collection, key)) {
    const auto value = figure(figures_of(resource), key);
    return value.value_or(std::string());
  }
  for (Property& each : properties_of(collection, resource.body, resource.create_time,
                                      resource.revision_create_time)) {
    if (each.key == key) return std::move(each.value);
  }
  return std::string();
}

bool needs_computed_fields(const ResourceQuery& query) {
  return is_computed(query.collection, query.order_key) ||
         std::any_of(
             query.restrictions.begin(), query.restrictions.end(),
             [&](const Restriction& each) { return is_computed(query.collection, each.key); });
}

Page<StoredResource> query_by_computed_fields(
    const ResourceQuery& query,
    const std::function<Page<StoredResource>(const ResourceQuery&)>& read_page) {
  ComputedQuery computed(query, read_page);
  return is_computed(query.collection, query.order_key) ? computed.in_computed_order()
                                                        : computed.in_stored_order();
}

}  // namespace tribodyn::server
