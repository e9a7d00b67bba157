#include "client/cpp/commands/json_import.h"

#include <filesystem>
#include <functional>
#include <map>
#include <set>

#include "client/cpp/failure.h"
#include "client/cpp/service/interrupt.h"
#include "client/cpp/text/text.h"

namespace tribodyn::client {
namespace {

using google::protobuf::Message;

void set_text(Message& resource, const char* field, const std::string& text) {
  resource.GetReflection()->SetString(&resource, resource.GetDescriptor()->FindFieldByName(field),
                                      text);
}

std::string without_revision(const std::string& name) { return name.substr(0, name.find('@')); }

std::string id_of(const FileResource& from, const std::string& given) {
  if (!given.empty()) return given;
  const std::string name = text_field(*from.resource, "name");
  return name.empty() ? id_of_file(from.origin) : resource_id(without_revision(name));
}

/// Shows how many of several are done; nothing for a few.
void show(ProgressDisplay& progress, const char* state, std::size_t done, std::size_t all) {
  constexpr std::size_t kFew = 20;
  constexpr std::size_t kStep = 10;
  if (all <= kFew || (done % kStep != 0 && done != all)) return;
  progress.show(
      {{"import", state, "", static_cast<double>(done) / static_cast<double>(all), done == all}});
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
  std::map<std::string, FileResource*> by_name;
  std::vector<std::string> order;
  for (FileResource& each : resources) {
    clear_output_only(*each.resource);
    const std::string name = kind.name_of(id_of(each, id));
    set_text(*each.resource, "name", name);
    const auto [at, is_new] = by_name.emplace(name, &each);
    if (!is_new) {
      throw Failure(kExitUsage,
                    name + " stands in " + at->second->origin + " and in " + each.origin);
    }
    order.push_back(name);
  }
  const std::function<void(const std::string&)> take = [&](const std::string& name) {
    const auto found = by_name.find(name);
    if (found == by_name.end() || found->second == nullptr) return;
    FileResource& resource = *found->second;
    found->second = nullptr;  // also ends a ring, which the server refuses
    take(without_revision(text_field(*resource.resource, "derived_from")));
    resources_.push_back(std::move(resource));
  };
  for (const std::string& name : order) take(name);
}

ResourcePointer JsonImport::send(Connection& connection, const Message& resource,
                                 const std::vector<std::string>& fields, bool replace,
                                 bool validate_only) const {
  if (!replace) {
    return kind_.calls->create(connection, resource, resource_id(text_field(resource, "name")),
                               validate_only);
  }
  UpdateOptions options;
  options.allow_missing = true;
  options.validate_only = validate_only;
  options.update_mask = fields;
  return kind_.calls->update(connection, resource, options);
}

std::vector<ResourcePointer> JsonImport::check(Connection& connection, bool replace,
                                               ProgressDisplay& progress) const {
  std::vector<ResourcePointer> checked;
  std::vector<std::string> refusals;
  std::set<std::string> before;
  for (const FileResource& each : resources_) {
    const ResourcePointer copy(each.resource->New());
    copy->CopyFrom(*each.resource);
    // It will be there once this one is written.
    if (before.count(text_field(*copy, "derived_from")) != 0) set_text(*copy, "derived_from", "");
    before.insert(text_field(*copy, "name"));
    try {
      checked.push_back(send(connection, *copy, each.fields, replace, true));
    } catch (const ServiceError& error) {
      if (error.kind() != ServiceError::Kind::kRefused) throw;
      refusals.push_back(each.origin + ": " + error.what());
    }
    show(progress, "checking", before.size(), resources_.size());
  }
  if (!refusals.empty()) {
    throw Failure(kExitFailed, joined(refusals, "\n") + "\n  Nothing was written.");
  }
  return checked;
}

std::vector<ResourcePointer> JsonImport::write(Connection& connection, bool replace,
                                               ProgressDisplay& progress) const {
  const InterruptGuard interrupts;
  std::vector<ResourcePointer> written;
  const auto stopped = [&](ExitCode code, const std::string& why) {
    return Failure(code, why + "\n  Written were " + std::to_string(written.size()) + " of " +
                             std::to_string(resources_.size()) + ", the next one would have been " +
                             text_field(*resources_[written.size()].resource, "name") +
                             ". Import with --replace to write all of them.");
  };
  for (const FileResource& each : resources_) {
    if (InterruptGuard::interrupted()) throw stopped(kExitInterrupted, "interrupted.");
    try {
      written.push_back(send(connection, *each.resource, each.fields, replace, false));
    } catch (const ServiceError& error) {
      const Failure failure(error);
      throw stopped(failure.exit_code(), failure.what());
    }
    show(progress, "writing", written.size(), resources_.size());
  }
  return written;
}

}  // namespace tribodyn::client
