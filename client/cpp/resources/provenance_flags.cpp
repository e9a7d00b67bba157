#include <google/protobuf/descriptor.h>

#include <algorithm>

#include "client/cpp/resources/edits.h"
#include "client/cpp/text/inputs.h"
#include "client/cpp/text/text.h"
#include "client/cpp/text/units.h"

namespace tribodyn::client {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

std::vector<std::string> provenance_words() {
  std::vector<std::string> words;
  const auto* type = v1::Provenance_descriptor();
  for (int i = 1; i < type->value_count(); ++i) {
    words.push_back(provenance_word(static_cast<v1::Provenance>(type->value(i)->number())));
  }
  return words;
}

/// The parameter before '=' and the text after it.
struct Assignment {
  const FieldDescriptor* field = nullptr;
  std::string text;
};

Assignment read_assignment(const ResourceKind& kind, const std::string& flag,
                           const std::string& form, const std::string& text,
                           Complaints& complaints) {
  const std::size_t mark = text.find('=');
  if (mark == std::string::npos) {
    complaints.push_back(flag + ": '" + printable(text) + "' must be " + form);
    return {};
  }
  std::string wrong;
  const FieldDescriptor* field = find_parameter(kind, text.substr(0, mark), wrong);
  if (field == nullptr) complaints.push_back(flag + ": " + wrong);
  return {field, text.substr(mark + 1)};
}

constexpr char kProvenanceForm[] = "FIELD=WORD[:SOURCE]";
constexpr char kUncertaintyForm[] = "FIELD=QUANTITY";

void read_provenance(const ResourceKind& kind, const std::string& text, ResourceEdits& edits,
                     Complaints& complaints) {
  const auto [field, value] =
      read_assignment(kind, "--provenance", kProvenanceForm, text, complaints);
  if (field == nullptr) return;
  const std::string word = value.substr(0, value.find(':'));
  const std::string source = word.size() < value.size() ? value.substr(word.size() + 1) : "";
  const std::vector<std::string> words = provenance_words();
  const auto found = std::find(words.begin(), words.end(), word);
  if (found == words.end()) {
    complaints.push_back("--provenance: '" + printable(word) + "' must be one of " +
                         joined(words, "|"));
    return;
  }
  const auto provenance = static_cast<v1::Provenance>(found - words.begin() + 1);
  edits.add("provenance", [name = field->name(), provenance, source](Message& resource) {
    auto& entry = provenance_entry(resource, name);
    entry.set_provenance(provenance);
    entry.set_source(source);
    entry.set_computed(false);
    entry.clear_warning();
  });
}

void read_uncertainty(const ResourceKind& kind, const std::string& text, ResourceEdits& edits,
                      Complaints& complaints) {
  const auto [field, value] =
      read_assignment(kind, "--uncertainty", kUncertaintyForm, text, complaints);
  if (field == nullptr) return;
  std::string wrong;
  // The uncertainty of a temperature is a difference, in kelvin.
  const std::string unit = unit_of_field(field->name());
  const std::string trade = trade_unit_of_field(field->name());
  const auto uncertainty = read_quantity(value, unit, trade == "C" ? "K" : trade, false, wrong);
  if (!uncertainty) {
    complaints.push_back("--uncertainty: '" + printable(value) + "' " + wrong);
    return;
  }
  // Marks an estimate with a stated uncertainty as stated by the user: the server would replace the
  // uncertainty when it computes the estimate again.
  edits.add("provenance", [name = field->name(), uncertainty](Message& resource) {
    auto& entry = provenance_entry(resource, name);
    entry.set_standard_uncertainty(*uncertainty);
    entry.set_computed(false);
  });
}

}  // namespace

v1::ParameterProvenance& provenance_entry(Message& resource, const std::string& field) {
  ProvenanceEntries& entries = provenance_entries_of(resource);
  for (auto& entry : entries) {
    if (entry.field() == field) return entry;
  }
  auto& entry = *entries.Add();
  entry.set_field(field);
  entry.set_provenance(v1::PROVENANCE_USER);
  return entry;
}

void drop_provenance(Message& resource, const std::string& field) {
  ProvenanceEntries& entries = provenance_entries_of(resource);
  entries.erase(std::remove_if(entries.begin(), entries.end(),
                               [&](const auto& entry) { return entry.field() == field; }),
                entries.end());
}

void set_user_provenance(Message& resource, const std::string& field) {
  drop_provenance(resource, field);
  provenance_entry(resource, field);
}

void add_provenance_flags(FlagList& flags, const ResourceKind& kind, ResourceEdits& edits) {
  flags.group("Origin of a parameter");
  Flag& provenance = flags.raw("--provenance", kProvenanceForm,
                               "E.g. thermal-conductivity=measured:\"Laboratory X, report 12\"; "
                               "words: " +
                                   joined(provenance_words(), "|") +
                                   ". Repeatable. Default for parameters that you give: user.");
  provenance.is_repeatable = true;
  provenance.read = [&kind, &edits](const std::vector<std::string>& texts, Complaints& complaints) {
    for (const std::string& text : texts) read_provenance(kind, text, edits, complaints);
  };
  Flag& uncertainty = flags.raw(
      "--uncertainty", kUncertaintyForm,
      "Standard uncertainty of a parameter, e.g. pressure-viscosity=0.5/GPa; repeatable.");
  uncertainty.is_repeatable = true;
  uncertainty.read = [&kind, &edits](const std::vector<std::string>& texts,
                                     Complaints& complaints) {
    for (const std::string& text : texts) read_uncertainty(kind, text, edits, complaints);
  };
}

}  // namespace tribodyn::client
