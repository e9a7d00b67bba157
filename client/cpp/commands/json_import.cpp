#include "client/cpp/commands/json_import.h"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <map>
#include <optional>
#include <utility>

#include "client/cpp/failure.h"
#include "client/cpp/text/text.h"

namespace tribodyn::client {
namespace {

std::string without_revision(const std::string& name) { return name.substr(0, name.find('@')); }

std::string id_of(const FileResource& from, const std::string& given) {
  if (!given.empty()) return given;
  const std::string name = text_field(*from.resource, "name");
  return name.empty() ? id_of_file(from.origin) : resource_id(without_revision(name));
}

/// The number in "start7]...", and how much of the text that is.
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

/// The column of a row that a path in its resource means; empty when none is.
std::string column_of(const FileResource& row, const std::string& path) {
  std::string column = path.substr(path.rfind('.') + 1);
  const Labels& labels = labels_of(*row.resource);
  const auto label = read_index(path, "labels[");
  if (label && label->value < static_cast<std::size_t>(labels.size())) {
    column = "labels." + labels[static_cast<int>(label->value)].key();
  }
  const auto found = std::find(row.columns.begin(), row.columns.end(), column);
  return found == row.columns.end() ? "" : column;
}

/// "fluids.csv row 3 column density_...: sentence", "fluids.json, lubricants[2]: sentence".
std::string complaint(const FileResource& about, const std::string& path,
                      const std::string& sentence) {
  const std::string column = column_of(about, path);
  if (!column.empty()) return about.origin + " column " + printable(column) + ": " + sentence;
  const std::string leaf = path.substr(path.rfind('.') + 1);
  const bool says_where = path == leaf && sentence.rfind(leaf + " ", 0) == 0;
  return about.origin + ": " + (path.empty() || says_where ? "" : path + ": ") + sentence;
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
    : kind_(kind), resources_(std::move(resources)) {
  std::map<std::string, const FileResource*> by_name;
  for (const FileResource& each : resources_) {
    clear_output_only(*each.resource);
    const std::string name = kind.name_of(id_of(each, id));
    set_text(*each.resource, "name", name);
    const auto [at, is_new] = by_name.emplace(name, &each);
    if (is_new) continue;
    throw Failure(kExitUsage, name + " stands in " + at->second->origin + " and in " + each.origin);
  }
}

std::vector<ResourcePointer> JsonImport::write(Connection& connection, bool replace,
                                               bool validate_only) const {
  if (resources_.empty()) return {};
  std::vector<BatchEntry> batch;
  for (const FileResource& each : resources_) batch.push_back({each.resource.get(), each.fields});
  return kind_.calls->write_all(connection, batch, replace, validate_only);
}

JsonImport::Verdict JsonImport::verdict(const ServiceError& refusal) const {
  Verdict out;
  std::vector<bool> is_wrong(resources_.size());
  bool says_all = true;
  for (const FieldViolation& each : refusal.violations()) {
    const auto index = read_index(each.field, "requests[");
    if (!index || index->value >= resources_.size()) {
      says_all = false;
      out.wrong.push_back(each.field == "*" ? each.description
                                            : each.field + ": " + each.description);
      continue;
    }
    is_wrong[index->value] = true;
    // "requests[3].lubricant.name": what follows the field that holds the resource.
    const std::string inside = each.field.substr(index->length);
    const std::size_t dot = inside.find('.', 1);
    const std::string path = dot == std::string::npos ? "" : inside.substr(dot + 1);
    out.wrong.push_back(complaint(resources_[index->value], path, each.description));
  }
  if (refusal.violations().empty()) {
    says_all = false;
    out.wrong.emplace_back(refusal.what());
  }
  if (!says_all) return out;
  for (std::size_t i = 0; i < resources_.size(); ++i) {
    if (!is_wrong[i]) out.valid.push_back(resources_[i].origin);
  }
  return out;
}

std::vector<ResourcePointer> JsonImport::send(Connection& connection, bool replace,
                                              bool validate_only) const {
  try {
    return write(connection, replace, validate_only);
  } catch (const ServiceError& error) {
    if (error.kind() == ServiceError::Kind::kRefused) {
      const bool taken = error.reason() == "ALREADY_EXISTS";
      throw Failure(kExitFailed, joined(verdict(error).wrong, "\n") + "\n  Nothing was written." +
                                     (taken ? " --replace makes new revisions." : ""));
    }
    if (error.kind() == ServiceError::Kind::kCannotConnect || validate_only) throw;
    const Failure failure(error);
    throw Failure(failure.exit_code(),
                  std::string(failure.what()) +
                      "\n  Either all were written or none. Import with --replace to be sure.");
  }
}

JsonImport::Verdict JsonImport::check(Connection& connection) const {
  try {
    write(connection, true, true);
  } catch (const ServiceError& error) {
    if (error.kind() != ServiceError::Kind::kRefused) throw;
    return verdict(error);
  }
  Verdict out;
  for (const FileResource& each : resources_) out.valid.push_back(each.origin);
  return out;
}

}  // namespace tribodyn::client
