#include "server/application/list_filter.h"

#include <fmt/format.h>
#include <google/protobuf/timestamp.pb.h>
#include <google/protobuf/util/time_util.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <optional>

#include "proto/enum_names.h"
#include "server/application/computed_fields.h"
#include "server/contract/output_only.h"
#include "server/contract/resource_names.h"
#include "server/storage/resource_types.h"
#include "server/support/text.h"

namespace tribodyn::server {
namespace {

using Comparison = Restriction::Comparison;
using google::protobuf::FieldDescriptor;
using google::protobuf::util::TimeUtil;

constexpr std::string_view kLabels = "labels.";
/// The operators, each before those that it begins with.
constexpr std::pair<std::string_view, Comparison> kOperators[] = {
    {"!=", Comparison::kNotEqual},
    {"<=", Comparison::kLessOrEqual},
    {">=", Comparison::kGreaterOrEqual},
    {"=", Comparison::kEqual},
    {"<", Comparison::kLess},
    {">", Comparison::kGreater},
    {":", Comparison::kContains}};

struct Token {
  std::string text;
  bool quoted = false;
};

/// Splits a filter into words, quoted texts and operators.
class Scanner {
 public:
  explicit Scanner(std::string_view text) : rest_(text) { skip_spaces(); }

  bool at_end() const { return rest_.empty(); }

  Token field() {
    return {take([](char c) { return is_word(c); }), false};
  }

  std::optional<Comparison> comparison() {
    for (const auto& [text, comparison] : kOperators) {
      if (!rest_.starts_with(text)) continue;
      rest_.remove_prefix(text.size());
      skip_spaces();
      return comparison;
    }
    return std::nullopt;
  }

  /// Returns nullopt if the closing quote is missing.
  std::optional<Token> value() {
    if (rest_.empty() || rest_.front() != '"') {
      return Token{take([](char c) { return std::isspace(static_cast<unsigned char>(c)) == 0; }),
                   false};
    }
    Token out{"", true};
    for (std::size_t i = 1; i < rest_.size(); ++i) {
      if (rest_[i] == '"') {
        rest_.remove_prefix(i + 1);
        skip_spaces();
        return out;
      }
      if (rest_[i] == '\\' && i + 1 < rest_.size()) ++i;
      out.text += rest_[i];
    }
    return std::nullopt;
  }

 private:
  static bool is_word(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '.' || c == '-';
  }

  template <class Test>
  std::string take(const Test& test) {
    const auto end = std::find_if_not(rest_.begin(), rest_.end(), test);
    std::string out(rest_.begin(), end);
    rest_.remove_prefix(out.size());
    skip_spaces();
    return out;
  }

  void skip_spaces() {
    while (!rest_.empty() && std::isspace(static_cast<unsigned char>(rest_.front())) != 0) {
      rest_.remove_prefix(1);
    }
  }

  std::string_view rest_;
};

std::optional<PropertyKind> kind_of(const std::string& key, const std::string& collection) {
  if (key == "name" || (key.starts_with(kLabels) && key.size() > kLabels.size())) {
    return PropertyKind::kText;
  }
  for (const PropertyField& field : property_fields(collection)) {
    if (field.key == key) return field.kind;
  }
  const ComputedField* computed = find_computed_field(collection, key);
  return computed == nullptr ? std::nullopt : std::optional(computed->kind);
}

/// Returns the key of the field with the short name `key`, e.g. "kv40"; else `key`.
std::string full_key(const std::string& key, const std::string& collection) {
  const ComputedField* computed = find_computed_field(collection, key);
  return computed == nullptr ? key : computed->key;
}

/// Returns the collection of the resources that a field names; empty if its values are not names.
std::string named_collection(const std::string& key, const std::string& collection) {
  if (key == "name" || key == "derived_from") return collection;
  if (collection != kSimulations && collection != kCampaigns) return "";
  if (key == "lubricant") return kLubricants;
  if (key == "gear_set") return kGearSets;
  if (key == "surface") return kSurfaces;
  return key == "vehicle" ? kVehicles : "";
}

/// Returns "GROUP_III" for "group-iii", the form of an enum in tables and flags.
std::string enum_name_of(std::string word) {
  std::transform(word.begin(), word.end(), word.begin(), [](unsigned char c) {
    return c == '-' || c == ' ' ? '_' : static_cast<char>(std::toupper(c));
  });
  return word;
}

std::string unknown_field_text(const std::string& key, const std::string& collection) {
  return fmt::format("\"{}\" is not a field of a filter on {}{}", plain_excerpt(key), collection,
                     meant_text(key, filter_fields(collection)));
}

std::optional<PropertyValue> flag_value(const std::string& text) {
  const std::string word = enum_name_of(text);
  if (word != "TRUE" && word != "FALSE") return std::nullopt;
  return std::int64_t{word == "TRUE" ? 1 : 0};
}

std::optional<PropertyValue> time_value(const std::string& text) {
  google::protobuf::Timestamp time;
  if (!TimeUtil::FromString(text, &time)) return std::nullopt;
  return TimeUtil::TimestampToMicroseconds(time);
}

/// Returns the short names of the values of a field. Zero is among them unless the server sets the
/// field: a state is never unspecified.
std::vector<std::string> enum_names(const FieldDescriptor& field) {
  const bool may_be_missing = !is_output_only(field);
  const auto* values = field.enum_type();
  std::vector<std::string> names;
  for (int i = 0; i < values->value_count(); ++i) {
    if (may_be_missing || values->value(i)->number() != 0)
      names.push_back(short_name(*values->value(i)));
  }
  return names;
}

/// Splits a filter into its conditions.
class ConditionReader {
 public:
  ConditionReader(std::string_view text, const std::string& example, Violations& violations)
      : scanner_(text), example_(example), violations_(violations) {}

  /// Calls `use` for each condition up to the first one that cannot be parsed.
  template <class Use>
  void read(const Use& use) {
    for (std::size_t count = 0; !scanner_.at_end(); ++count) {
      if (count == kMaximumRestrictions) {
        return complain(fmt::format("more than {} restrictions", kMaximumRestrictions));
      }
      const std::optional<FilterCondition> next = condition();
      if (!next) return;
      use(*next);
      if (scanner_.at_end()) return;
      const std::string joint = scanner_.field().text;
      if (joint != "AND" || scanner_.at_end()) {
        return complain("restrictions are joined by AND, e.g. " + example_);
      }
    }
  }

 private:
  void complain(std::string text) { violations_.add("filter", std::move(text)); }

  /// Returns nullopt, and adds a violation, if the rest of the filter cannot be parsed.
  std::optional<FilterCondition> condition() {
    FilterCondition out;
    out.field = scanner_.field().text;
    const std::optional<Comparison> comparison = scanner_.comparison();
    if (out.field.empty() || !comparison) {
      complain("allowed: field, one of = != < <= > >= :, value; e.g. " +
               example_.substr(0, example_.find(" AND ")));
      return std::nullopt;
    }
    const std::optional<Token> value = scanner_.value();
    if (!value || (value->text.empty() && !value->quoted)) {
      complain(fmt::format("the value of {} is missing or its quotes are open",
                           plain_excerpt(out.field)));
      return std::nullopt;
    }
    out.comparison = *comparison;
    out.value = value->text;
    out.is_quoted = value->quoted;
    return out;
  }

  Scanner scanner_;
  const std::string& example_;
  Violations& violations_;
};

class FilterReader {
 public:
  FilterReader(const std::string& collection, Violations& violations)
      : collection_(collection), violations_(violations) {}

  std::vector<Restriction> read(std::string_view text) {
    static const std::string kExample = "condition = USED AND labels.project = axle";
    std::vector<Restriction> out;
    ConditionReader(text, kExample, violations_).read([&](const FilterCondition& condition) {
      Restriction next;
      next.key = condition.field;
      next.comparison = condition.comparison;
      read_value({condition.value, condition.is_quoted}, next);
      next.key = full_key(next.key, collection_);
      out.push_back(std::move(next));
    });
    return out;
  }

 private:
  void complain(std::string text) { violations_.add("filter", std::move(text)); }

  void read_value(const Token& value, Restriction& out) {
    const auto kind = kind_of(out.key, collection_);
    if (!kind) return complain(unknown_field_text(out.key, collection_));
    if (out.comparison == Comparison::kContains && value.text == "*" && !value.quoted) {
      out.comparison = Comparison::kPresent;
      return;
    }
    if (out.comparison == Comparison::kContains && *kind != PropertyKind::kText) {
      return complain(fmt::format("{} is not a text; \":\" applies only to texts", out.key));
    }
    switch (*kind) {
      case PropertyKind::kText:
        return read_text(value, out);
      case PropertyKind::kNumber:
        return set(filter_number(value.text), value, "a finite number", out);
      case PropertyKind::kFlag:
        return set(flag_value(value.text), value, "true or false", out);
      case PropertyKind::kTime:
        return set(time_value(value.text), value, "a time such as 2026-01-31T12:00:00Z", out);
      case PropertyKind::kEnum:
        return read_enum(value, out);
    }
  }

  void set(const std::optional<PropertyValue>& read, const Token& value, const char* allowed,
           Restriction& out) {
    if (read) {
      out.value = *read;
    } else {
      complain(
          fmt::format("{} = \"{}\"; allowed: {}", out.key, plain_excerpt(value.text), allowed));
    }
  }

  /// Adds the collection to the name of a resource that lacks it.
  void read_text(const Token& value, Restriction& out) const {
    out.value = value.text;
    const std::string named = named_collection(out.key, collection_);
    const bool is_whole_name =
        out.comparison == Comparison::kEqual || out.comparison == Comparison::kNotEqual;
    if (is_whole_name && !named.empty() && !value.text.empty() &&
        value.text.find('/') == std::string::npos) {
      out.value = named + "/" + value.text;
    }
  }

  void read_enum(const Token& value, Restriction& out) {
    const auto message = new_resource(collection_);
    const auto& field = *message->GetDescriptor()->FindFieldByName(out.key);
    const std::vector<std::string> names = enum_names(field);
    std::string name = enum_name_of(value.text);
    if (const auto* found = find_value(*field.enum_type(), name)) name = short_name(*found);
    if (std::find(names.begin(), names.end(), name) == names.end()) {
      return complain(fmt::format("{} = \"{}\" is unknown{}", out.key, plain_excerpt(value.text),
                                  meant_text(name, names)));
    }
    out.value = name;
  }

  const std::string& collection_;
  Violations& violations_;
};

bool is_too_long(std::string_view filter, Violations& violations) {
  if (filter.size() <= kMaximumFilterLength) return false;
  violations.add("filter", "{} bytes; allowed: at most {}", filter.size(), kMaximumFilterLength);
  return true;
}

}  // namespace

std::optional<double> filter_number(std::string_view text) {
  const auto value = parse_number<double>(text);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

std::vector<FilterCondition> split_filter(std::string_view filter, const std::string& example,
                                          Violations& violations) {
  std::vector<FilterCondition> out;
  if (is_too_long(filter, violations)) return out;
  ConditionReader(filter, example, violations).read([&out](const FilterCondition& each) {
    out.push_back(each);
  });
  return out;
}

std::vector<Restriction> parse_filter(std::string_view filter, const std::string& collection,
                                      Violations& violations) {
  if (is_too_long(filter, violations)) return {};
  return FilterReader(collection, violations).read(filter);
}

std::vector<Restriction> parse_job_filter(std::string_view filter, const std::string& collection,
                                          Violations& violations) {
  const auto message = new_resource(collection);
  const auto& descriptor = *message->GetDescriptor();
  std::vector<Restriction> out = parse_filter(filter, collection, violations);
  for (Restriction& each : out) {
    const bool is_equality =
        each.comparison == Comparison::kEqual || each.comparison == Comparison::kNotEqual;
    const bool is_label = each.key.starts_with(kLabels);
    if (each.key == "name") {
      violations.add("filter", "lists cannot be filtered by name; use Get" + descriptor.name());
    } else if (!is_equality && kind_of(each.key, collection) != PropertyKind::kTime &&
               !(is_label && each.comparison == Comparison::kPresent) &&
               !(each.key == "display_name" && each.comparison == Comparison::kContains)) {
      violations.add("filter",
                     each.key + ": allowed: = or !=, of labels also :*, of display_name also :");
    }
    const std::string* word = std::get_if<std::string>(&each.value);
    const FieldDescriptor* field = descriptor.FindFieldByName(each.key);
    if (word == nullptr || field == nullptr || field->enum_type() == nullptr) continue;
    if (const auto* value = find_value(*field->enum_type(), *word)) {
      each.value = std::int64_t{value->number()};
    }
  }
  return out;
}

Order parse_order(std::string_view order_by, const std::string& collection,
                  Violations& violations) {
  Scanner scanner(order_by.substr(0, kMaximumFilterLength));
  if (scanner.at_end()) return {};
  Order out;
  out.key = scanner.field().text;
  const std::string direction = scanner.field().text;
  const bool known =
      out.key == "name" || (kind_of(out.key, collection) && out.key.find('.') == std::string::npos);
  if (!known) {
    std::vector<std::string> fields = filter_fields(collection);
    std::erase(fields, "labels.KEY");
    violations.add("order_by", "\"{}\" is nothing to order {} by{}", plain_excerpt(out.key),
                   collection, meant_text(out.key, fields));
  }
  if (!scanner.at_end() || (!direction.empty() && direction != "asc" && direction != "desc")) {
    violations.add("order_by", "allowed: one field, then nothing, asc or desc");
  }
  out.descending = direction == "desc";
  out.key = out.key == "name" ? "" : full_key(out.key, collection);
  return out;
}

std::vector<std::string> filter_fields(const std::string& collection) {
  std::vector<std::string> out = {"labels.KEY", "name"};
  for (const PropertyField& field : property_fields(collection)) out.push_back(field.key);
  for (const ComputedField& field : computed_fields(collection)) {
    out.push_back(field.key);
    out.insert(out.end(), field.short_names.begin(), field.short_names.end());
  }
  std::sort(out.begin(), out.end());
  return out;
}

}  // namespace tribodyn::server
