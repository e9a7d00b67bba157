#pragma once

#include <functional>
#include <set>
#include <string>
#include <vector>

#include "client/cpp/resources/kind.h"
#include "client/cpp/text/flags.h"

namespace tribodyn::client {

/// The changes of a resource that the flags of a command describe, in the order of the flags.
class ResourceEdits {
 public:
  using Edit = std::function<void(google::protobuf::Message&)>;

  /// Adds an edit of the top-level field `field`.
  void add(const std::string& field, Edit edit);
  /// Like add(), but returns false without adding the edit if `key` has been set before.
  bool add_once(const std::string& key, const std::string& field, Edit edit);
  /// Adds an edit that is applied before all others: --unset clears what other flags then set.
  void add_removal(const std::string& field, Edit edit);
  /// Records that another edit changes this top-level field too.
  void touch(const std::string& field) { fields_.insert(field); }
  bool empty() const { return edits_.empty() && removals_.empty(); }
  void apply(google::protobuf::Message& resource) const;
  /// Returns the top-level fields that were changed: the mask of an update.
  std::vector<std::string> fields() const { return {fields_.begin(), fields_.end()}; }

 private:
  std::vector<Edit> removals_;
  std::vector<Edit> edits_;
  std::set<std::string> fields_;
  std::set<std::string> keys_;
};

/// Adds a flag for every parameter, text and class of the kind, for measurements, labels and the
/// origin of parameters. The flags write to `edits`, which must outlive them.
void add_edit_flags(FlagList& flags, const ResourceKind& kind, ResourceEdits& edits);
/// Adds the flags that only an update has: --unset and --remove-label.
void add_removal_flags(FlagList& flags, const ResourceKind& kind, ResourceEdits& edits);

// Parts of add_edit_flags().
void add_measurement_list_flags(FlagList& flags, ResourceEdits& edits);
void add_boundary_friction_flag(FlagList& flags, ResourceEdits& edits);
void add_provenance_flags(FlagList& flags, const ResourceKind& kind, ResourceEdits& edits);

/// Returns the parameter of the kind for a word such as "thermal-conductivity", its full name, or
/// either with underscores. Returns null and sets `wrong` to a complaint with the nearest name if
/// there is none.
const google::protobuf::FieldDescriptor* find_parameter(const ResourceKind& kind,
                                                        const std::string& word,
                                                        std::string& wrong);
/// Returns the names of all parameters as flags spell them, without units.
std::vector<std::string> parameter_words(const ResourceKind& kind);

/// A data-sheet name of a field, e.g. "kv40", and the unit of a number without unit that is given
/// under that name; an empty unit means that the number must state one.
struct TradeName {
  std::string word;
  std::string bare_unit;
};
std::vector<TradeName> trade_names(const google::protobuf::FieldDescriptor& field);

/// Sets the provenance of a parameter to "user" and clears its former source, uncertainty and
/// warning, which applied to another value.
void set_user_provenance(google::protobuf::Message& resource, const std::string& field);

/// Returns the provenance entry of a field; creates an entry "user" if there is none.
v1::ParameterProvenance& provenance_entry(google::protobuf::Message& resource,
                                          const std::string& field);

void drop_provenance(google::protobuf::Message& resource, const std::string& field);

/// Sets a label, or removes it if `value` is null.
void set_label(google::protobuf::Message& resource, const std::string& key,
               const std::string* value);

/// Returns e.g. "group-iii" for BASE_OIL_CLASS_GROUP_III; enum_words() returns the words of all
/// values except the unspecified one.
std::string enum_word(const google::protobuf::EnumValueDescriptor& value);
std::vector<std::string> enum_words(const google::protobuf::EnumDescriptor& type);

}  // namespace tribodyn::client
