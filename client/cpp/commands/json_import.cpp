#include "client/cpp/commands/json_import.h"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "client/cpp/failure.h"
#include "client/cpp/resources/grouped_complaints.h"
#include "client/cpp/text/text.h"

namespace tribodyn::client {
namespace {

std::string without_revision(const std::string& name) { return name.substr(0, name.find('@')); }

std::string id_of(const FileResource& from, const std::string& given) {
  if (!given.empty()) return given;
  const std::string name = text_field(*from.resource, "name");
  return name.empty() ? id_of_file(from.origin) : from.kind->id_of(without_revision(name));
}

/// An index such as 3 in "3]...", and the length of its text.
struct Index {
  std::size_t value = 0;
  std::size_t length = 0;
};

std::optional<Index> read_index(const std::string& text, const std::string& start) {
  if (text.rfind(start, 0) != 0) return std::nullopt;
  Index index;
  const char* digits = text.data() + start.size();
  const auto [end, error] = std::from_chars(digits, text.data() + text.size(), index.value);
  if (error != std::errc() || end == text.data() + text.size() || *end != ']') return std::nullopt;
  index.length = static_cast<std::size_t>(end - text.data()) + 1;
  return index;
}

/// Returns the typed header of the column for a path in its resource; empty if there is none.
std::string column_of(const FileResource& row, const std::string& path) {
  const auto typed = [&](const std::string& column) {
    const auto found = row.columns.find(column);
    return found == row.columns.end() ? std::string() : found->second;
  };
  const auto label = read_index(path, "labels[");
  const Labels& labels = labels_of(*row.resource);
  if (label && label->value < static_cast<std::size_t>(labels.size())) {
    return typed("labels." + labels[static_cast<int>(label->value)].key());
  }
  const auto known = read_index(path, "provenance[");
  const ProvenanceEntries& entries = provenance_entries_of(*row.resource);
  if (known && known->value < static_cast<std::size_t>(entries.size())) {
    return typed(entries[static_cast<int>(known->value)].field() + path.substr(known->length));
  }
  // The innermost part of "measurements.viscosities[2].x" that is a column.
  std::vector<std::string> parts = split(path, '.');
  std::reverse(parts.begin(), parts.end());
  for (const std::string& part : parts) {
    if (std::string column = typed(part.substr(0, part.find('['))); !column.empty()) {
      return column;
    }
  }
  return "";
}

std::size_t leading_number(const std::string& text) {
  std::size_t out = 0;
  std::from_chars(text.data(), text.data() + text.size(), out);
  return out;
}

/// Adds e.g. "fluids.csv row 3 column density_...: sentence" or "fluids.json, lubricants[2]:
/// sentence".
void add_complaint(const FileResource& about, const std::string& path, const std::string& sentence,
                   GroupedComplaints& complaints) {
  const std::string column = column_of(about, path);
  if (!column.empty()) {
    return complaints.add(about.origin, "column " + printable(column), sentence);
  }
  const std::string leaf = path.substr(path.rfind('.') + 1);
  const bool says_where = path == leaf && sentence.rfind(leaf + " ", 0) == 0;
  complaints.add(about.origin, "", (path.empty() || says_where ? "" : path + ": ") + sentence);
}

}  // namespace

std::string id_of_file(const std::string& path) {
  std::string id = std::filesystem::path(path).stem().string();
  for (char& c : id) {
    if (c == ' ') c = '-';
  }
  return id;
}

JsonImport::JsonImport(const ResourceKind& kind, std::vector<FileResource> resources,
                       const std::string& id)
    : kind_(kind) {
  std::map<std::string, std::string> origins;
  for (FileResource& each : resources) {
    clear_output_only(*each.resource);
    const std::string name = kind.name_of(id_of(each, id));
    set_text(*each.resource, "name", name);
    const auto [at, is_new] = origins.emplace(name, each.origin);
    if (is_new) {
      resources_.push_back(std::move(each));
    } else {
      duplicates_.push_back(name + " occurs in " + at->second + " and in " + each.origin);
    }
  }
}

bool JsonImport::is_large() const {
  std::size_t bytes = 0;
  for (const FileResource& each : resources_) bytes += each.resource->ByteSizeLong();
  return resources_.size() > 200 || bytes > 1'000'000;
}

std::vector<ResourcePointer> JsonImport::write(Connection& connection, bool replace,
                                               bool validate_only, bool names_alone) const {
  if (resources_.empty()) return {};
  std::vector<BatchEntry> batch;
  for (const FileResource& each : resources_) batch.push_back({each.resource.get(), each.fields});
  BatchOptions options;
  options.validate_only = validate_only;
  options.allow_missing = true;
  if (names_alone) options.read_mask = {"name"};
  return kind_.calls->write_all(connection, batch, replace, options);
}

JsonImport::Verdict JsonImport::verdict(const ServiceError& refusal) const {
  Verdict out;
  GroupedComplaints wrong;
  std::vector<bool> is_wrong(resources_.size());
  bool says_all = true;
  for (const FieldViolation& each : refusal.violations()) {
    const auto index = read_index(each.field, "requests[");
    if (each.field == "read_mask") {  // the client's own choice, which no flag names
      says_all = false;
      wrong.add("one answer has no room for " + std::to_string(resources_.size()) + " " +
                kind_.plural + " in full: leave --output out, or send fewer at a time");
      continue;
    }
    if (!index || index->value >= resources_.size()) {
      says_all = false;
      if (each.field == "*") {  // "51 more violations"
        wrong.add_unlisted(leading_number(each.description));
      } else {
        wrong.add(each.field + ": " + each.description);
      }
      continue;
    }
    is_wrong[index->value] = true;
    // The part of "requests[3].lubricant.name" after the field that holds the resource.
    const std::string inside = each.field.substr(index->length);
    const std::size_t dot = inside.find('.', 1);
    const std::string path = dot == std::string::npos ? "" : inside.substr(dot + 1);
    add_complaint(resources_[index->value], path, each.description, wrong);
  }
  if (refusal.violations().empty()) {
    says_all = false;
    wrong.add(refusal.what());
  }
  out.wrong = wrong.lines();
  if (!says_all) return out;
  for (std::size_t i = 0; i < resources_.size(); ++i) {
    if (!is_wrong[i]) out.valid.push_back(resources_[i].origin);
  }
  return out;
}

std::vector<ResourcePointer> JsonImport::send(Connection& connection, bool replace,
                                              bool validate_only, bool names_alone) const {
  if (!duplicates_.empty()) {
    throw Failure(kExitUsage, joined(check(connection).wrong, "\n") + "\n  Nothing was written.");
  }
  try {
    return write(connection, replace, validate_only, names_alone);
  } catch (const ServiceError& error) {
    if (error.kind() == ServiceError::Kind::kRefused) {
      const bool taken = error.reason() == "ALREADY_EXISTS";
      throw Failure(kExitFailed, joined(verdict(error).wrong, "\n") + "\n  Nothing was written." +
                                     (taken ? " Use --replace to create new revisions." : ""));
    }
    if (error.kind() == ServiceError::Kind::kCannotConnect || validate_only) throw;
    const Failure failure(error);
    throw Failure(
        failure.exit_code(),
        std::string(failure.what()) +
            "\n  Either all resources were written or none. Repeat the import with --replace.");
  }
}

JsonImport::Verdict JsonImport::check(Connection& connection) const {
  Verdict out;
  try {
    write(connection, true, true, true);
    for (const FileResource& each : resources_) out.valid.push_back(each.origin);
  } catch (const ServiceError& error) {
    if (error.kind() != ServiceError::Kind::kRefused) throw;
    out = verdict(error);
  }
  out.wrong.insert(out.wrong.begin(), duplicates_.begin(), duplicates_.end());
  return out;
}

}  // namespace tribodyn::client
