#pragma once

#include <google/protobuf/message.h>

#include <memory>
#include <string>
#include <vector>

#include "proto/field_behavior.h"
#include "tribodyn/client/connection.h"

namespace tribodyn::client {

/// A resource of any kind.
using ResourcePointer = std::unique_ptr<google::protobuf::Message>;

/// A resource of a batch and the fields that an update sets; empty: all.
struct BatchEntry {
  const google::protobuf::Message* resource;
  std::vector<std::string> fields;
};

struct ResourceList {
  std::vector<ResourcePointer> resources;
  std::string next_page_token;  ///< empty: this is the last page
  int total_size = 0;           ///< of the whole list; -1: not counted
};

/// The calls of Connection for resources whose kind is known only at run time. Every message passed
/// in must be of that kind.
class ResourceCalls {
 public:
  virtual ~ResourceCalls() = default;
  virtual ResourcePointer create(Connection& connection, const google::protobuf::Message& resource,
                                 const std::string& id, bool validate_only) const = 0;
  virtual ResourcePointer get(Connection& connection, const std::string& name) const = 0;
  virtual ResourceList list(Connection& connection, const ListOptions& options) const = 0;
  virtual ResourcePointer update(Connection& connection, const google::protobuf::Message& resource,
                                 const UpdateOptions& options) const = 0;
  /// Writes all resources or none and returns them in their order; `replace` updates those that
  /// exist and creates the others.
  virtual std::vector<ResourcePointer> write_all(Connection& connection,
                                                 const std::vector<BatchEntry>& batch, bool replace,
                                                 const BatchOptions& options) const = 0;
  virtual ResourceList revisions(Connection& connection, const std::string& name,
                                 int limit) const = 0;
  virtual ResourcePointer remove(Connection& connection, const std::string& name,
                                 const std::string& etag) const = 0;
  virtual ResourcePointer undelete(Connection& connection, const std::string& name,
                                   const std::string& etag) const = 0;
  virtual v1::PurgeReport purge(Connection& connection, const std::string& name,
                                const PurgeOptions& options) const = 0;
};

/// One of the kinds of proto/resource_kinds.h, with its names.
struct ResourceKind {
  std::string word;        ///< on the command line: "gear-sets"
  std::string singular;    ///< "gear set"
  std::string plural;      ///< "gear sets"
  std::string collection;  ///< "gearSets"
  std::string list_field;  ///< in list responses and in files with several: "gear_sets"
  std::string example;     ///< id of a resource that exists on every server
  const google::protobuf::Message* prototype;
  std::shared_ptr<const ResourceCalls> calls;

  ResourcePointer make() const { return ResourcePointer(prototype->New()); }
  /// Returns "gearSets/reference-axle" for "reference-axle" and for "gearSets/reference-axle".
  std::string name_of(const std::string& id_or_name) const;
  /// Returns "reference-axle" for both. Another collection's name is returned unchanged, so that
  /// the server refuses it.
  std::string id_of(const std::string& id_or_name) const;
};

const std::vector<ResourceKind>& resource_kinds();
const ResourceKind& kind_of(const google::protobuf::Descriptor& type);

/// Returns a text field of a resource, e.g. "name"; empty if the resource has no such field.
std::string text_field(const google::protobuf::Message& resource, const std::string& field);

/// Sets a text field; throws std::logic_error if the resource has no such field.
void set_text(google::protobuf::Message& resource, const char* field, const std::string& text);

/// Whether the resource is deleted.
bool is_deleted(const google::protobuf::Message& resource);

// Fields that every kind has.
using Labels = google::protobuf::RepeatedPtrField<v1::Label>;
using ProvenanceEntries = google::protobuf::RepeatedPtrField<v1::ParameterProvenance>;
Labels& labels_of(google::protobuf::Message& resource);
const Labels& labels_of(const google::protobuf::Message& resource);
ProvenanceEntries& provenance_entries_of(google::protobuf::Message& resource);
const ProvenanceEntries& provenance_entries_of(const google::protobuf::Message& resource);

/// Clears the fields that only the server sets.
void clear_output_only(google::protobuf::Message& resource);

}  // namespace tribodyn::client
