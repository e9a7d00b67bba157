#include "client/cpp/commands/resource_writes.h"

#include <algorithm>
#include <iostream>
#include <map>

#include "client/cpp/report/resource_report.h"
#include "client/cpp/resources/json_input.h"
#include "client/cpp/text/text.h"

namespace tribodyn::client {
namespace {

using google::protobuf::Message;

struct WriteFlags {
  std::string name;
  std::string file;
  std::string like;
  std::string etag;
  ResourceEdits edits;
  TableFiles tables;
  bool validate_only = false;
  bool allow_missing = false;
};

/// Returns the only resource of a file; throws Failure if there are several.
ResourcePointer read_one(const ResourceKind& kind, const std::string& path) {
  auto resources = read_resources(read_file(path), path, &kind);
  if (resources.size() != 1) {
    throw Failure(kExitUsage, path + " contains " + std::to_string(resources.size()) + " " +
                                  kind.plural + "; `tribodyn " + kind.word +
                                  " import` reads several");
  }
  clear_output_only(*resources.front().resource);
  return std::move(resources.front().resource);
}

void add_name(Command& command, const ResourceKind& kind, const std::shared_ptr<WriteFlags>& flags,
              const std::string& description, bool exists) {
  command.flags.group("Arguments");
  Flag& name = command.flags.text("name", "NAME", description,
                                  [flags](const std::string& text) { flags->name = text; });
  if (exists) {
    name.collection = kind.collection;
  } else {
    name.field = kind.singular + "_id";  // "lubricant_id", of the request
    std::replace(name.field.begin(), name.field.end(), ' ', '_');
  }
}

void add_write_flags(Command& command, const std::shared_ptr<WriteFlags>& flags,
                     const std::string& file_description) {
  command.flags.group("Options");
  command.flags.text("--file,-f", "FILE.json", file_description,
                     [flags](const std::string& path) { flags->file = path; });
  command.flags.toggle("--validate-only", "Check everything and show the outcome; write nothing.",
                       [flags] { flags->validate_only = true; });
}

/// Returns the resource to which the flags of create are applied.
ResourcePointer start_of(Connection& connection, const ResourceKind& kind,
                         const WriteFlags& flags) {
  if (!flags.file.empty()) return read_one(kind, flags.file);
  if (!flags.like.empty()) return copy_of(connection, kind, flags.like, flags.tables);
  return kind.make();
}

int run_create(const ResourceKind& kind, const WriteFlags& flags, const CommonOptions& options) {
  Connection connection = options.connect();
  if (flags.name.starts_with("projects/") &&
      !flags.name.starts_with("projects/" + connection.project() + "/")) {
    throw Failure(kExitUsage, "NAME: '" + printable(flags.name) + "' is not of the project '" +
                                  printable(connection.project()) + "'; set --project");
  }
  const ResourcePointer resource = start_of(connection, kind, flags);
  flags.edits.apply(*resource);
  set_text(*resource, "name", "");
  const ResourcePointer created = create_with_tables(
      connection, kind, *resource, kind.id_of(flags.name), flags.tables, flags.validate_only);
  show_written("created", *created, flags.validate_only, options.output_format,
               ResourceDetail::kSummary);
  if (kind.word == "lubricants" && options.output_format == OutputFormat::kTable &&
      !flags.validate_only) {
    std::cout << "\nNext:  tribodyn curve --lubricant " << kind.id_of(flags.name) << "\n";
  }
  return kExitOk;
}

/// Reads the current revision, applies the changes and sends it back with its etag, so that changes
/// that somebody else made meanwhile are not overwritten.
int run_update(const ResourceKind& kind, const WriteFlags& flags, const CommonOptions& options) {
  Connection connection = options.connect();
  const std::string name = kind.name_of(flags.name);
  UpdateOptions update;
  update.validate_only = flags.validate_only;
  update.allow_missing = flags.allow_missing;
  ResourcePointer resource;
  if (flags.file.empty()) {
    resource = kind.calls->get(connection, name);
    update.update_mask = flags.edits.fields();
  } else {
    resource = read_one(kind, flags.file);
    update.update_mask = {"*"};
  }
  flags.edits.apply(*resource);
  set_text(*resource, "name", name);
  if (!flags.etag.empty()) set_text(*resource, "etag", flags.etag);
  const ResourcePointer updated = kind.calls->update(connection, *resource, update);
  show_written("updated", *updated, flags.validate_only, options.output_format,
               ResourceDetail::kAll);
  return kExitOk;
}

/// Returns the flags that the short help lists for a kind: figures of a data sheet or a drawing.
std::vector<std::string> main_figures(const ResourceKind& kind) {
  static const std::map<std::string, std::vector<std::string>> kFlags = {
      {"lubricants",
       {"--kv40", "--kv100", "--density15", "--brookfield", "--kv100-sheared", "--base-oil-class",
        "--pressure-viscosity"}},
      {"gear-sets", {"--pinion-teeth", "--gear-teeth"}},
      {"surfaces",
       {"--composite-rms-height", "--asperity-density", "--asperity-radius",
        "--asperity-friction-coefficient"}},
      {"vehicles", {"--mass", "--drag-coefficient", "--wheel-radius", "--frontal-area"}},
  };
  const auto found = kFlags.find(kind.word);
  return found == kFlags.end() ? std::vector<std::string>() : found->second;
}

/// Returns the flags that name tables of a kind.
std::vector<std::string> main_tables(const ResourceKind& kind) {
  static const std::map<std::string, std::vector<std::string>> kFlags = {
      {"lubricants", {"--viscosity-table"}},
      {"gear-sets", {"--tooth-contact", "--series"}},
      {"surfaces", {"--profile", "--levelling"}},
  };
  const auto found = kFlags.find(kind.word);
  return found == kFlags.end() ? std::vector<std::string>() : found->second;
}

void show_in_short_help(const std::vector<std::string>& flags, Command& command) {
  command.main_flags.insert(command.main_flags.end(), flags.begin(), flags.end());
}

}  // namespace

void show_written(const char* done, const Message& resource, bool validate_only,
                  OutputFormat format, ResourceDetail detail) {
  if (format == OutputFormat::kTable) {
    const auto* revision = resource.GetDescriptor()->FindFieldByName("revision");
    std::cout << (validate_only ? "valid, not written: " : std::string(done) + " ")
              << printable(text_field(resource, "name"));
    if (!validate_only) {
      std::cout << ", revision " << resource.GetReflection()->GetInt32(resource, revision);
    }
    std::cout << "\n\n";
  }
  std::cout << resource_text(resource, format, validate_only ? ResourceDetail::kAll : detail);
}

Command create_command(const ResourceKind& kind) {
  const auto flags = std::make_shared<WriteFlags>();
  Command command{kind.word + " create", "a new " + kind.singular, "", {}, {}, {}, {}};
  if (kind.word == "lubricants") {
    command.about =
        "Creates a gear oil as a laboratory reports it: KV40, KV100 and the density at 15 C are "
        "enough. The server fits the other parameters of the model, or estimates them from the "
        "base-oil class, and the command prints each with its uncertainty and source. A number is "
        "in the "
        "unit that the flag shows, or states its own: 0.868g/cm3, 98Pas; `tribodyn help units` "
        "lists them.";
    command.examples = {
        "tribodyn lubricants create my-oil --kv40 103 --kv100 15.1 --density15 868 "
        "--base-oil-class pao --brookfield -40=98000",
        "tribodyn lubricants create my-oil --viscosity-table my-oil.csv --density15 868",
        "tribodyn lubricants create my-oil --file my-oil.json --pressure-viscosity 20/GPa "
        "--label project=axle"};
  } else {
    command.about = "Creates a " + kind.singular +
                    ". A number is in the unit that the flag shows, or states its own, e.g. "
                    "400nm; `tribodyn help units` lists them.";
    command.examples = {"tribodyn " + kind.word + " create mine --like " + kind.example,
                        "tribodyn " + kind.word + " create mine --file mine.json"};
    if (kind.word == "gear-sets") {
      command.examples.emplace_back(
          "tribodyn gear-sets create mine --like reference-axle --tooth-contact contact.csv "
          "--series "
          "series.csv");
    } else if (kind.word == "surfaces") {
      command.examples.emplace_back(
          "tribodyn surfaces create mine --like run-in --profile pinion,axial,p.csv --profile "
          "gear,axial,g.csv");
    }
  }
  add_name(command, kind, flags, "Id: letters, digits, '-', '_', '.'; e.g. mine.", false);
  add_table_flags(command.flags, kind, flags->tables);
  add_edit_flags(command.flags, kind, flags->edits);
  add_write_flags(command, flags,
                  "Start from this JSON file, in the form that export writes; flags override it.");
  command.flags
      .text("--like", "NAME", "Start from a copy of this " + kind.singular + "; flags override it.",
            [flags](const std::string& text) { flags->like = text; })
      .collection = kind.collection;
  show_in_short_help(main_figures(kind), command);
  show_in_short_help(main_tables(kind), command);
  show_in_short_help({"--label", "--title", "--like", "--file"}, command);
  command.check = [flags, &kind](Complaints& complaints) {
    if (flags->name.empty()) {
      complaints.emplace_back("NAME is missing, e.g. tribodyn " + kind.word + " create mine");
    }
    if (!flags->like.empty() && !flags->file.empty()) {
      complaints.emplace_back("give either --like or --file");
    }
    // After another complaint, the missing values may have been in a flag that was not read.
    if (complaints.empty() && flags->edits.empty() && flags->file.empty() && flags->like.empty() &&
        flags->tables.empty()) {
      complaints.emplace_back(std::string("no properties given; ") +
                              (kind.word == "lubricants"
                                   ? "at least --kv40 and --kv100 (or --file) are needed; "
                                   : "") +
                              "see `tribodyn " + kind.word + " create --help`");
    }
  };
  command.run = [&kind, flags](const CommonOptions& options) {
    return run_create(kind, *flags, options);
  };
  return command;
}

Command update_command(const ResourceKind& kind) {
  const auto flags = std::make_shared<WriteFlags>();
  Command command{
      kind.word + " update",
      "a new revision of a " + kind.singular,
      "Sets the fields that the flags name and keeps the others. That creates a new revision; "
      "results of older revisions keep theirs. The server recomputes values that were fitted or "
      "estimated from changed fields.",
      {"tribodyn " + kind.word + " update " + kind.example + " --label project=axle"},
      {},
      {},
      {}};
  if (kind.word == "lubricants") {
    command.examples.emplace_back(
        "tribodyn lubricants update my-oil --pressure-viscosity 18/GPa "
        "--provenance pressure-viscosity=measured:report-12");
  }
  add_name(command, kind, flags, "The " + kind.singular + ", e.g. " + kind.example + ".", true);
  add_edit_flags(command.flags, kind, flags->edits);
  add_removal_flags(command.flags, kind, flags->edits);
  add_write_flags(command, flags, "Replace the whole resource by this JSON file.");
  command.flags.toggle("--allow-missing", "With --file: create the resource if it does not exist.",
                       [flags] { flags->allow_missing = true; });
  command.flags.text("--etag", "ETAG", "Fail if the resource has changed since it had this etag.",
                     [flags](const std::string& text) { flags->etag = text; });
  show_in_short_help(main_figures(kind), command);
  show_in_short_help({"--label", "--title", "--unset", "--provenance", "--uncertainty", "--file"},
                     command);
  command.check = [flags, &kind](Complaints& complaints) {
    if (flags->name.empty()) {
      complaints.emplace_back("NAME is missing; `tribodyn " + kind.word + " list` lists the names");
    }
    if (complaints.empty() && flags->edits.empty() && flags->file.empty()) {
      complaints.emplace_back("no changes given; see `tribodyn " + kind.word + " update --help`");
    }
    if (flags->allow_missing && flags->file.empty()) {
      complaints.emplace_back("--allow-missing needs --file");
    }
  };
  command.run = [&kind, flags](const CommonOptions& options) {
    return run_update(kind, *flags, options);
  };
  return command;
}

}  // namespace tribodyn::client
