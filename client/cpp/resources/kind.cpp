#include "client/cpp/resources/kind.h"

#include <algorithm>
#include <stdexcept>
#include <string_view>
#include <type_traits>
#include <utility>

#include "client/cpp/text/text.h"
#include "proto/resource_kinds.h"

namespace tribodyn::client {
namespace {

using google::protobuf::Message;

template <class Resource>
class TypedCalls final : public ResourceCalls {
 public:
  ResourcePointer create(Connection& connection, const Message& resource, const std::string& id,
                         bool validate_only) const override {
    return own(connection.create(typed(resource), id, validate_only));
  }
  ResourcePointer get(Connection& connection, const std::string& name) const override {
    return own(connection.get<Resource>(name));
  }
  ResourceList list(Connection& connection, const ListOptions& options) const override {
    return own_all(connection.list<Resource>(options));
  }
  ResourcePointer update(Connection& connection, const Message& resource,
                         const UpdateOptions& options) const override {
    return own(connection.update(typed(resource), options));
  }
  std::vector<ResourcePointer> write_all(Connection& connection,
                                         const std::vector<BatchEntry>& batch, bool replace,
                                         const BatchOptions& options) const override {
    if (replace) {
      std::vector<ResourceUpdate<Resource>> updates;
      for (const BatchEntry& each : batch) {
        updates.push_back({typed(*each.resource),
                           each.fields.empty() ? std::vector<std::string>{"*"} : each.fields});
      }
      return own_each(connection.update_all(updates, options));
    }
    std::vector<Resource> resources;
    for (const BatchEntry& each : batch) resources.push_back(typed(*each.resource));
    return own_each(connection.create_all(resources, options));
  }
  ResourceList revisions(Connection& connection, const std::string& name,
                         int limit) const override {
    return own_all(connection.revisions<Resource>(name, limit));
  }
  ResourcePointer remove(Connection& connection, const std::string& name,
                         const std::string& etag) const override {
    return own(connection.remove<Resource>(name, etag));
  }
  ResourcePointer undelete(Connection& connection, const std::string& name,
                           const std::string& etag) const override {
    return own(connection.undelete<Resource>(name, etag));
  }
  v1::PurgeReport purge(Connection& connection, const std::string& name,
                        const PurgeOptions& options) const override {
    return connection.purge<Resource>(name, options);
  }

 private:
  static const Resource& typed(const Message& message) {
    return dynamic_cast<const Resource&>(message);
  }
  static ResourcePointer own(Resource&& resource) {
    return std::make_unique<Resource>(std::move(resource));
  }
  static std::vector<ResourcePointer> own_each(std::vector<Resource>&& resources) {
    std::vector<ResourcePointer> out;
    for (Resource& resource : resources) out.push_back(own(std::move(resource)));
    return out;
  }
  static ResourceList own_all(Listing<Resource>&& listing) {
    return {own_each(std::move(listing.resources)), std::move(listing.next_page_token),
            listing.total_size};
  }
};

/// Makes the names of a kind from the field that holds it in requests, e.g. "gear_set".
template <class Resource>
ResourceKind make_kind(const std::string& field, const char* collection, const char* seed) {
  std::string word = field + "s", singular = field;
  std::replace(word.begin(), word.end(), '_', '-');
  std::replace(singular.begin(), singular.end(), '_', ' ');
  return {word,
          singular,
          singular + "s",
          collection,
          field + "s",
          seed,
          &Resource::default_instance(),
          std::make_shared<TypedCalls<Resource>>()};
}

/// Returns the visitor's result for the resource in its own type.
template <class Answer, class Resource, class Visitor>
Answer& visit(Resource& resource, const Visitor& visitor) {
// A type cannot be in parentheses. NOLINTBEGIN(bugprone-macro-parentheses)
#define TRIBODYN_VISIT(Type, field, collection, seed)                                   \
  using Type = std::conditional_t<std::is_const_v<Resource>, const v1::Type, v1::Type>; \
  if (auto* as = dynamic_cast<Type*>(&resource)) return visitor(*as);
  // NOLINTEND(bugprone-macro-parentheses)
  TRIBODYN_RESOURCE_KINDS(TRIBODYN_VISIT)
#undef TRIBODYN_VISIT
  throw std::logic_error(resource.GetTypeName() + " is not a resource");
}

}  // namespace

Labels& labels_of(Message& resource) {
  return visit<Labels>(resource, [](auto& as) -> Labels& { return *as.mutable_labels(); });
}
const Labels& labels_of(const Message& resource) {
  return visit<const Labels>(resource, [](auto& as) -> const Labels& { return as.labels(); });
}
ProvenanceEntries& provenance_entries_of(Message& resource) {
  return visit<ProvenanceEntries>(
      resource, [](auto& as) -> ProvenanceEntries& { return *as.mutable_provenance(); });
}
const ProvenanceEntries& provenance_entries_of(const Message& resource) {
  return visit<const ProvenanceEntries>(
      resource, [](auto& as) -> const ProvenanceEntries& { return as.provenance(); });
}

std::string ResourceKind::name_of(const std::string& id_or_name) const {
  return resource_name(collection, id_or_name);
}

std::string ResourceKind::id_of(const std::string& id_or_name) const {
  constexpr std::string_view kProjects = "projects/";
  const std::size_t slash = id_or_name.starts_with(kProjects)
                                ? id_or_name.find('/', kProjects.size())
                                : std::string::npos;
  const std::string prefix = collection + "/";
  const std::string relative =
      slash == std::string::npos ? id_or_name : id_or_name.substr(slash + 1);
  return relative.starts_with(prefix) ? relative.substr(prefix.size()) : id_or_name;
}

const std::vector<ResourceKind>& resource_kinds() {
#define TRIBODYN_MAKE_KIND(Resource, field, collection, seed) \
  make_kind<v1::Resource>(#field, #collection, seed),
  static const std::vector<ResourceKind> kKinds = {TRIBODYN_RESOURCE_KINDS(TRIBODYN_MAKE_KIND)};
#undef TRIBODYN_MAKE_KIND
  return kKinds;
}

const ResourceKind& kind_of(const google::protobuf::Descriptor& type) {
  for (const ResourceKind& kind : resource_kinds()) {
    if (kind.prototype->GetDescriptor() == &type) return kind;
  }
  throw std::logic_error(type.full_name() + " is not a resource");
}

std::string text_field(const Message& resource, const std::string& field) {
  const auto* descriptor = resource.GetDescriptor()->FindFieldByName(field);
  return descriptor == nullptr ? "" : resource.GetReflection()->GetString(resource, descriptor);
}

void set_text(Message& resource, const char* field, const std::string& text) {
  resource.GetReflection()->SetString(&resource, resource.GetDescriptor()->FindFieldByName(field),
                                      text);
}

bool is_deleted(const Message& resource) {
  return resource.GetReflection()->HasField(
      resource, resource.GetDescriptor()->FindFieldByName("delete_time"));
}

void clear_output_only(Message& resource) {
  const auto* descriptor = resource.GetDescriptor();
  for (int i = 0; i < descriptor->field_count(); ++i) {
    const auto* field = descriptor->field(i);
    if (is_output_only(*field)) resource.GetReflection()->ClearField(&resource, field);
  }
}

}  // namespace tribodyn::client
