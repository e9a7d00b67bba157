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

/// A resource of a batch, and the fields of it that an update takes over; empty: all.
struct BatchEntry {
  const google::protobuf::Message* resource;
  std::vector<std::string> fields;
};

struct ResourceList {
  std::vector<ResourcePointer> resources;
  std::string next_page_token;  ///< empty: there are no more
};

/// What a batch wrote, in the order of what was sent.
struct BatchWritten {
  std::vector<std::string> names;
  std::vector<ResourcePointer> resources;  ///< empty: too many for one answer, see BatchResult
};

/// The calls of Connection for resources whose kind is known only at run time. Every message given
/// must be of that kind.
class ResourceCalls {
 public:
  virtual ~ResourceCalls() = default;
  virtual ResourcePointer create(Connection& connection, const google::protobuf::Message& resource,
                                 const std::string& id, bool validate_only) const = 0;
  virtual ResourcePointer get(Connection& connection, const std::string& name) const = 0;
  virtual ResourceList list(Connection& connection, const ListOptions& options) const = 0;
  virtual ResourcePointer update(Connection& connection, const google::protobuf::Message& resource,
                                 const UpdateOptions& options) const = 0;
  /// All or none; `replace` updates what is there already.
  virtual BatchWritten write_all(Connection& connection, const std::vector<BatchEntry>& batch,
                                 bool replace, bool validate_only) const = 0;
  virtual ResourceList revisions(Connection& connection, const std::string& name,
                                 int limit) const = 0;
  virtual ResourcePointer remove(Connection& connection, const std::string& name,
                                 const std::string& etag) const = 0;
  virtual ResourcePointer undelete(Connection& connection, const std::string& name,
                                   const std::string& etag) const = 0;
};

/// One of the four kinds of resource, as commands name it.
struct ResourceKind {
  std::string word;        ///< of the command line: "gear-sets"
  std::string singular;    ///< "gear set"
  std::string plural;      ///< "gear sets"
  std::string collection;  ///< "gearSets"
  std::string list_field;  ///< of the list responses, and so of files of several: "gear_sets"
  std::string example;     ///< id of a resource that every server has
  const google::protobuf::Message* prototype;
  std::shared_ptr<const ResourceCalls> calls;

  ResourcePointer make() const { return ResourcePointer(prototype->New()); }
  /// "gearSets/A" from "A" or "gearSets/A".
  std::string name_of(const std::string& id_or_name) const;
};

const std::vector<ResourceKind>& resource_kinds();
const ResourceKind& kind_of(const google::protobuf::Descriptor& type);

/// A text field of a resource, e.g. "name"; empty when it has none of that name.
std::string text_field(const google::protobuf::Message& resource, const std::string& field);

/// Sets a text field that the resource must have.
void set_text(google::protobuf::Message& resource, const char* field, const std::string& text);

/// Whether it was deleted, and not undeleted.
bool is_deleted(const google::protobuf::Message& resource);

// What every kind has.
using Labels = google::protobuf::RepeatedPtrField<v1::Label>;
using ProvenanceEntries = google::protobuf::RepeatedPtrField<v1::ParameterProvenance>;
Labels& labels_of(google::protobuf::Message& resource);
const Labels& labels_of(const google::protobuf::Message& resource);
ProvenanceEntries& provenance_entries_of(google::protobuf::Message& resource);
const ProvenanceEntries& provenance_entries_of(const google::protobuf::Message& resource);

/// Clears what only the server sets.
void clear_output_only(google::protobuf::Message& resource);

}  // namespace tribodyn::client
