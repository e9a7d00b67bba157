#pragma once

#include <functional>
#include <set>
#include <string>
#include <vector>

#include "client/cpp/commands/flags.h"
#include "client/cpp/resources/kind.h"

namespace tribodyn::client {

/// What the flags of a command change in a resource, in the order in which they were given.
class ResourceEdits {
 public:
  using Edit = std::function<void(google::protobuf::Message&)>;

  /// `field` is the top-level field that the edit changes.
  void add(const std::string& field, Edit edit);
  /// As add; false when the same thing (`key`) has been set before.
  bool add_once(const std::string& key, const std::string& field, Edit edit);
  /// An edit that comes before all others: --unset makes room for what other flags set.
  void add_removal(const std::string& field, Edit edit);
  /// Another edit changes this top-level field too.
  void touch(const std::string& field) { fields_.insert(field); }
  bool empty() const { return edits_.empty() && removals_.empty(); }
  void apply(google::protobuf::Message& resource) const;
  /// Top-level fields that were changed: the mask of an update.
  std::vector<std::string> fields() const { return {fields_.begin(), fields_.end()}; }

 private:
  std::vector<Edit> removals_;
  std::vector<Edit> edits_;
  std::set<std::string> fields_;
  std::set<std::string> keys_;
};

/// A flag for every parameter, text and class of the kind, for measurements, labels and how each
/// parameter is known. They write to `edits`, which must outlive the flags.
void add_edit_flags(FlagList& flags, const ResourceKind& kind, ResourceEdits& edits);
/// Those that only an update can mean: --unset and --remove-label.
void add_removal_flags(FlagList& flags, const ResourceKind& kind, ResourceEdits& edits);

// Parts of add_edit_flags.
void add_measurement_list_flags(FlagList& flags, ResourceEdits& edits);
void add_provenance_flags(FlagList& flags, const ResourceKind& kind, ResourceEdits& edits);

/// The parameter of the kind that a person means by "thermal-conductivity", its full name, or
/// either with underscores; null and a complaint that names the nearest.
const google::protobuf::FieldDescriptor* find_parameter(const ResourceKind& kind,
                                                        const std::string& word,
                                                        std::string& wrong);
/// Names of all parameters, as flags spell them, without units.
std::vector<std::string> parameter_words(const ResourceKind& kind);

/// A name that the trade has for a field, "kv40", and the unit of a bare number that is given to
/// it; empty where the number must have a unit.
struct TradeName {
  std::string word;
  std::string bare_unit;
};
std::vector<TradeName> trade_names(const google::protobuf::FieldDescriptor& field);

/// States that the client gave the value of a parameter: what was known of another value is void.
void set_user_provenance(google::protobuf::Message& resource, const std::string& field);

/// How a field is known; an entry "user" is made where there is none.
v1::ParameterProvenance& provenance_entry(google::protobuf::Message& resource,
                                          const std::string& field);

void drop_provenance(google::protobuf::Message& resource, const std::string& field);

/// Sets a label, or takes it away when there is no value.
void set_label(google::protobuf::Message& resource, const std::string& key,
               const std::string* value);

/// "group-iii" of BASE_OIL_CLASS_GROUP_III; the words of all values but the unspecified one.
std::string enum_word(const google::protobuf::EnumValueDescriptor& value);
std::vector<std::string> enum_words(const google::protobuf::EnumDescriptor& type);

}  // namespace tribodyn::client
