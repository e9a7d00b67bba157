#include "client/cpp/commands/flag_errors.h"

#include <algorithm>
#include <charconv>
#include <optional>
#include <set>

#include "client/cpp/text/text.h"
#include "client/cpp/text/units.h"

namespace tribodyn::client {
namespace {

constexpr char kAllowed[] = "allowed: ";

/// A field's path, split into the flag that sets it and the index of the value among that flag's
/// values.
struct FlagValue {
  const TypedFlag* flag = nullptr;
  std::optional<std::size_t> index;  ///< for a field in a list
};

/// Returns the innermost part of a path that a flag sets: "density_15_..." for
/// "lubricant.measurements.density_15_...", "brookfield_viscosities" for
/// "...brookfield_viscosities[1].temperature_celsius". The first part of the path is the resource,
/// or else the field, as of "constraints[1].figure.column": it comes last.
FlagValue flag_value_of(const std::string& path, const TypedFlags& typed) {
  const std::vector<std::string> parts = split(path, '.');
  for (std::size_t i = parts.size(); i-- > 0;) {
    const std::size_t bracket = parts[i].find('[');
    const auto found = typed.find(parts[i].substr(0, bracket));
    if (found == typed.end()) continue;
    if (bracket == std::string::npos) return {&found->second, std::nullopt};
    std::size_t index = 0;
    const char* end = parts[i].data() + parts[i].size();
    if (std::from_chars(parts[i].data() + bracket + 1, end, index).ec != std::errc()) return {};
    return {&found->second, index};
  }
  return {};
}

struct AllowedRange {
  double low, high;
};

/// Returns the numbers in "...; allowed: 500 to 2000 kg/m3 (eq 26)".
std::optional<AllowedRange> allowed_range_of(const std::string& description) {
  const std::size_t start = description.find(kAllowed);
  if (start == std::string::npos) return std::nullopt;
  const auto words = split(description.substr(start + sizeof(kAllowed) - 1), ' ');
  if (words.size() < 3 || words[1] != "to") return std::nullopt;
  std::string wrong;
  const auto low = read_quantity(words[0], "", "", false, wrong);
  const auto high = read_quantity(words[2], "", "", false, wrong);
  if (!low || !high) return std::nullopt;
  return AllowedRange{*low, *high};
}

/// Returns the text of a violation in terms of the command line.
std::string described_by_flag(const FieldViolation& violation, const FlagValue& value) {
  const TypedFlag& flag = *value.flag;
  std::string leaf = violation.field.substr(violation.field.rfind('.') + 1);
  leaf = leaf.substr(0, leaf.find('['));
  const std::size_t index = value.index.value_or(0);
  const bool is_one_text = value.index ? index < flag.texts.size() : flag.texts.size() == 1;
  const std::string typed = is_one_text ? printable(flag.texts[index]) : "";
  const bool is_pair = typed.find('=') != std::string::npos;
  if (is_pair) return flag.name + " " + typed + ": " + violation.description;
  const std::string unit = unit_of_field(leaf);
  std::string text = flag.name;
  std::string wrong;
  const bool is_bare = read_quantity(typed, "", "", false, wrong).has_value();
  // The violation states the value in the unit of the field. The typed text precedes it where it
  // looks different.
  const bool same_unit = flag.bare_unit == unit || unit_ratio(flag.bare_unit, unit) == 1.0;
  if (!unit.empty() && !typed.empty() && !(same_unit && is_bare)) text += " " + typed;
  const bool names_field = violation.description.rfind(leaf + " ", 0) == 0;
  // A sentence about a text, such as the name of a column, that does not quote it.
  const bool is_unquoted = unit.empty() && !is_bare && !names_field &&
                           violation.description.find(typed) == std::string::npos;
  if (is_unquoted) text += " " + typed;
  text += names_field ? violation.description.substr(leaf.size()) : ": " + violation.description;
  const auto range = allowed_range_of(violation.description);
  if (!range || typed.empty()) return text;
  const std::string cure = unit_slip(typed, unit, flag.bare_unit, range->low, range->high);
  if (cure.empty()) return text;
  // The server's advice on the unit is replaced: it does not contain the syntax of the flag.
  const std::size_t slip = text.find(" looks like ");
  if (slip != std::string::npos) text.erase(std::min(text.rfind("; ", slip), text.size()));
  return text + "; " + cure;
}

}  // namespace

ServiceError with_flag_names(const ServiceError& error, const TypedFlags& typed) {
  if (error.kind() != ServiceError::Kind::kRefused) return error;
  std::string text = error.what();
  std::vector<FieldViolation> violations = error.violations();
  std::set<std::string> shown;  // one flag may set many elements
  for (FieldViolation& violation : violations) {
    const FlagValue value = flag_value_of(violation.field, typed);
    if (value.flag == nullptr) continue;
    const std::string described = described_by_flag(violation, value);
    for (const std::string& line : {"\n  " + violation.field + ": " + violation.description,
                                    "\n  " + violation.description}) {
      const std::size_t at = text.find(line);
      if (at == std::string::npos) continue;
      text.replace(at, line.size(), shown.insert(described).second ? "\n  " + described : "");
      break;
    }
    violation.field = value.flag->name;
    violation.description = described;
  }
  return {text, error.status_code(), error.reason(), violations, error.retry_delay_seconds()};
}

std::string typed_name(const Flag& flag, const std::vector<std::string>& arguments) {
  for (const std::string& name : split(flag.names, ',')) {
    const bool is_there =
        std::any_of(arguments.begin(), arguments.end(), [&](const std::string& argument) {
          return argument == name || argument.rfind(name + "=", 0) == 0;
        });
    if (is_there) return name;
  }
  return flag.first_name();
}

void name_flags_as_typed(const std::vector<std::string>& arguments,
                         const std::vector<const FlagList*>& lists, Complaints& complaints) {
  for (const FlagList* list : lists) {
    for (const Flag& flag : list->flags()) {
      const std::string first = flag.first_name();
      const std::string typed = typed_name(flag, arguments);
      if (flag.is_positional() || typed == first) continue;
      for (std::string& complaint : complaints) {
        const bool is_of_flag =
            complaint.rfind(first + " ", 0) == 0 || complaint.rfind(first + ":", 0) == 0;
        if (is_of_flag) complaint.replace(0, first.size(), typed);
      }
    }
  }
}

}  // namespace tribodyn::client
