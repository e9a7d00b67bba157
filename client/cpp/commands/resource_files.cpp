#include <functional>
#include <iostream>
#include <map>
#include <optional>
#include <set>

#include "client/cpp/commands/json_import.h"
#include "client/cpp/commands/resource_writes.h"
#include "client/cpp/report/resource_report.h"
#include "client/cpp/resources/json_input.h"
#include "client/cpp/resources/row_table.h"
#include "client/cpp/resources/table_files.h"
#include "client/cpp/text/table_text.h"
#include "client/cpp/text/text.h"

namespace tribodyn::client {
namespace {

struct ImportFlags {
  std::vector<std::string> files;
  std::string id;
  std::string like;
  ResourceEdits edits;
  TableFiles tables;
  bool replace = false;
  bool validate_only = false;
};

struct ExportFlags {
  std::vector<std::string> names;
  std::string file;
  std::string tooth_contact;
  std::string series;
  std::string viscosity_table;
  bool all = false;
};

/// Returns a function that looks up current resources of a kind by name. It makes one request and
/// caches the result.
std::function<ResourcePointer(const std::string&)> present_resources(Connection& connection,
                                                                     const ResourceKind& kind) {
  const auto by_name = std::make_shared<std::optional<std::map<std::string, ResourcePointer>>>();
  return [by_name, &connection, &kind](const std::string& name) -> ResourcePointer {
    if (!*by_name) {
      by_name->emplace();
      for (ResourcePointer& each : kind.calls->list(connection, {}).resources) {
        const std::string key = text_field(*each, "name");
        (*by_name)->emplace(key, std::move(each));
      }
    }
    const auto found = (*by_name)->find(name);
    if (found == (*by_name)->end()) return nullptr;
    ResourcePointer copy = kind.make();
    copy->CopyFrom(*found->second);
    return copy;
  };
}

/// Returns the resources that an import writes: rows of tables and resources of JSON files.
std::vector<FileResource> resources_of(Connection& connection, const ResourceKind& kind,
                                       const ImportFlags& flags) {
  std::vector<FileResource> resources;
  ResourcePointer like;
  if (!flags.like.empty()) like = base_of_rows(connection, kind, flags.like);
  RowBases bases;
  bases.like = like.get();
  if (flags.replace) bases.present = present_resources(connection, kind);
  const auto add = [&](std::vector<FileResource> read) {
    for (FileResource& each : read) {
      flags.edits.apply(*each.resource);
      if (!each.fields.empty()) {
        for (const std::string& field : flags.edits.fields()) each.fields.push_back(field);
      }
      resources.push_back(std::move(each));
    }
  };
  for (const std::string& path : flags.files) {
    if (!is_table_file(path)) {
      add(read_resources(read_file(path), path, &kind));
      continue;
    }
    RowTable table = read_row_table(read_table_file(path, kLargestFile), path, kind, bases);
    if (!table.note.empty()) std::cerr << "tribodyn: " << printable(table.note) << "\n";
    add(std::move(table.resources));
  }
  return resources;
}

constexpr std::size_t kMostComparedAtOnce = 8;  ///< lubricants of one `tribodyn compare`

/// Imports all resources or none.
int import_resources(const ResourceKind& kind, const ImportFlags& flags,
                     const CommonOptions& options) {
  Connection connection = options.connect();
  std::vector<FileResource> resources = resources_of(connection, kind, flags);
  if (resources.size() > 1 && !flags.id.empty()) {
    throw Failure(kExitUsage, "--id names one " + kind.singular + ", but there are " +
                                  std::to_string(resources.size()));
  }
  if (flags.tables.eq46_as_published) {
    throw Failure(kExitUsage, "--as-published applies to profiles: --profile is missing");
  }
  const JsonImport import(kind, std::move(resources), flags.id);
  const bool is_table = options.output_format == OutputFormat::kTable;
  // What is not written cannot be read afterwards.
  const bool names_alone = import.is_large() && (is_table || !flags.validate_only);
  std::vector<ResourcePointer> done =
      import.send(connection, flags.replace, flags.validate_only, names_alone);
  if (names_alone && !flags.validate_only) {
    for (ResourcePointer& each : done)
      each = kind.calls->get(connection, text_field(*each, "name"));
  }
  if (!is_table) {
    std::cout << resources_text(kind, done, options.output_format, false);
    return kExitOk;
  }
  if (done.size() == 1) {
    show_written("imported", *done.front(), flags.validate_only, options.output_format,
                 ResourceDetail::kSummary);
    return kExitOk;
  }
  for (const ResourcePointer& each : done) {
    std::cout << (flags.validate_only ? "valid, not written: " : "imported ")
              << printable(text_field(*each, "name")) << "\n";
    if (const auto* lubricant = dynamic_cast<const v1::Lubricant*>(each.get())) {
      std::cout << characterisation_warnings(*lubricant);
    }
  }
  if (kind.word == "lubricants" && !flags.validate_only && done.size() <= kMostComparedAtOnce) {
    std::cout << "\nNext:  tribodyn compare";
    for (const ResourcePointer& each : done) {
      std::cout << " " << printable(resource_id(text_field(*each, "name")));
    }
    std::cout << " --speed 30,60,90,120\n";
  }
  return kExitOk;
}

int import_tables(const ResourceKind& kind, const ImportFlags& flags,
                  const CommonOptions& options) {
  if (flags.files.size() > 1 && kind.word != "surfaces") {
    throw Failure(kExitUsage, "import only one table at a time");
  }
  if (flags.replace) {
    throw Failure(kExitUsage,
                  "--replace is for JSON files and tables of one " + kind.singular + " per row");
  }
  TableFiles tables = flags.tables;
  for (const std::string& path : flags.files) add_table(kind, path, tables);
  const std::string id = !flags.id.empty() ? flags.id : id_of_file(flags.files.front());
  Connection connection = options.connect();
  const ResourcePointer resource =
      flags.like.empty() ? kind.make() : copy_of(connection, kind, flags.like, tables);
  flags.edits.apply(*resource);
  const ResourcePointer imported =
      create_with_tables(connection, kind, *resource, id, tables, flags.validate_only);
  show_written("imported", *imported, flags.validate_only, options.output_format,
               ResourceDetail::kSummary);
  if (kind.word == "lubricants" && options.output_format == OutputFormat::kTable &&
      !flags.validate_only) {
    std::cout << "\nNext:  tribodyn curve --lubricant " << id << "\n";
  }
  return kExitOk;
}

void check_import(const ResourceKind& kind, const ImportFlags& flags, Complaints& complaints) {
  if (flags.files.empty() && flags.tables.empty()) {
    complaints.emplace_back("FILE is missing, e.g. tribodyn " + kind.word + " import file.json");
    return;
  }
  std::size_t tables = 0;
  for (const std::string& path : flags.files) tables += is_table_file(path) ? 1 : 0;
  if (tables > 0 && tables < flags.files.size()) {
    complaints.emplace_back("give either JSON files or tables (.csv), not both");
  }
  if (!flags.like.empty() && !flags.files.empty() && tables == 0) {
    complaints.emplace_back("--like applies only to tables; a JSON file contains complete " +
                            kind.plural);
  }
  if (flags.files.empty() && flags.id.empty()) complaints.emplace_back("--id is missing");
}

/// Returns all resources that are not deleted, and the deleted ones from which others are derived:
/// an import requires them.
std::vector<ResourcePointer> all_to_export(Connection& connection, const ResourceKind& kind) {
  ListOptions options;
  options.show_deleted = true;
  std::vector<ResourcePointer> resources = kind.calls->list(connection, options).resources;
  std::map<std::string, const google::protobuf::Message*> by_name;
  for (const ResourcePointer& each : resources) by_name[text_field(*each, "name")] = each.get();
  std::set<const google::protobuf::Message*> exported;
  for (const ResourcePointer& each : resources) {
    if (is_deleted(*each)) continue;
    const google::protobuf::Message* next = each.get();
    while (next != nullptr && exported.insert(next).second) {
      const std::string parent = text_field(*next, "derived_from");
      const auto found = by_name.find(parent.substr(0, parent.find('@')));
      next = found == by_name.end() ? nullptr : found->second;
    }
  }
  std::erase_if(resources, [&](const auto& each) { return exported.count(each.get()) == 0; });
  return resources;
}

int run_export(const ResourceKind& kind, const ExportFlags& flags, const CommonOptions& options) {
  Connection connection = options.connect();
  std::vector<ResourcePointer> resources;
  if (flags.all) {
    resources = all_to_export(connection, kind);
  } else {
    for (const std::string& name : flags.names) {
      resources.push_back(kind.calls->get(connection, kind.name_of(name)));
    }
  }
  if (!flags.tooth_contact.empty() || !flags.series.empty()) {
    const auto& gear_set = dynamic_cast<const v1::GearSet&>(*resources.front());
    if (!flags.tooth_contact.empty()) {
      write_file(flags.tooth_contact, tooth_contact_csv(gear_set));
    }
    if (!flags.series.empty()) write_file(flags.series, series_csv(gear_set));
    if (flags.file.empty()) return kExitOk;
  }
  if (!flags.viscosity_table.empty()) {
    write_file(flags.viscosity_table,
               viscosity_table_csv(dynamic_cast<const v1::Lubricant&>(*resources.front())));
    if (flags.file.empty()) return kExitOk;
  }
  std::string text;
  const bool csv = options.output_format == OutputFormat::kCsv;
  if (csv && kind.word == "gear-sets") {
    throw Failure(kExitUsage,
                  "a gear set is not a row of a table; use --tooth-contact and --series");
  } else if (csv) {
    std::string lost;
    text = row_table(kind, resources, lost);
    if (!lost.empty()) {
      std::cerr << "tribodyn: a table cannot contain " << lost << "; export JSON for them\n";
    }
  } else {
    text = export_text(kind, resources);
  }
  if (flags.file.empty()) {
    std::cout << text;
  } else {
    write_file(flags.file, text);
  }
  return kExitOk;
}

}  // namespace

ResourcePointer base_of_rows(Connection& connection, const ResourceKind& kind,
                             const std::string& like) {
  ResourcePointer base = copy_of(connection, kind, like, {});
  for (const char* field : {"display_name", "description", "external_sample_id", "lims_id"}) {
    if (base->GetDescriptor()->FindFieldByName(field) != nullptr) set_text(*base, field, "");
  }
  return base;
}

Command import_command(const ResourceKind& kind) {
  const auto flags = std::make_shared<ImportFlags>();
  Command command{
      kind.word + " import",
      kind.plural + " from files",
      "Creates " + kind.plural +
          " from files in the form that export writes. An import creates all of them, or "
          "none if one is wrong.",
      {"tribodyn " + kind.word + " import " + kind.plural.substr(0, 4) + ".json"},
      {},
      {},
      {}};
  if (kind.word != "gear-sets") {
    command.about += " A file is JSON, or a CSV table with a column \"name\" and one " +
                     kind.singular + " per row.";
  }
  if (kind.word == "lubricants") {
    command.about +=
        " A table of viscosities (CSV) gives one lubricant: the server fits Vogel's law by least "
        "squares and the command prints the residuals.";
    command.examples = {"tribodyn lubricants import my-oil.csv",
                        "tribodyn lubricants import fluids.json --replace",
                        "tribodyn lubricants import table.csv --id my-oil --density15 870 "
                        "--base-oil-class polyalphaolefin"};
  } else if (kind.word == "gear-sets") {
    command.about += " A table of tooth contact data (CSV) gives one gear set.";
    command.examples.emplace_back(
        "tribodyn gear-sets import contact.csv --series series.csv --id mine --like "
        "reference-axle");
  } else if (kind.word == "surfaces") {
    command.about += " Measured profiles (CSV) give one surface.";
    command.examples.emplace_back(
        "tribodyn surfaces import --id mine --profile pinion,axial,p.csv --profile "
        "gear,axial,g.csv");
  }
  command.flags.group("Arguments");
  command.flags.texts("file", "FILE",
                      "JSON, or a table whose name ends in .csv, .tsv, .tab or .txt; - is JSON "
                      "from standard input.",
                      [flags](const std::string& path) { flags->files.push_back(path); });
  command.flags.group("Options");
  command.flags.text("--id", "NAME",
                     "Id of the resource. Default: the name in the file, else the file's own name.",
                     [flags, &kind](const std::string& text) { flags->id = kind.id_of(text); });
  command.flags
      .text(
          "--like", "NAME",
          "For a table: missing columns and empty cells are taken from this " + kind.singular + ".",
          [flags](const std::string& text) { flags->like = text; })
      .collection = kind.collection;
  command.flags.toggle("--replace", "Create a new revision of each resource that exists.",
                       [flags] { flags->replace = true; });
  command.flags.toggle("--validate-only", "Check everything and show the outcome; write nothing.",
                       [flags] { flags->validate_only = true; });
  add_table_flags(command.flags, kind, flags->tables);
  add_edit_flags(command.flags, kind, flags->edits);
  command.check = [flags, &kind](Complaints& complaints) {
    check_import(kind, *flags, complaints);
  };
  command.run = [&kind, flags](const CommonOptions& options) {
    const bool table = !flags->tables.empty() ||
                       (is_table_file(flags->files.front()) &&
                        (kind.word == "gear-sets" ||
                         !is_row_table(read_table_file(flags->files.front(), kLargestFile))));
    return table ? import_tables(kind, *flags, options) : import_resources(kind, *flags, options);
  };
  return command;
}

Command export_command(const ResourceKind& kind) {
  const auto flags = std::make_shared<ExportFlags>();
  Command command{
      kind.word + " export",
      kind.plural + " as JSON that import reads",
      "Writes " + kind.plural + " as JSON with every digit, without revision, times and etag.",
      {"tribodyn " + kind.word + " export " + kind.example + " --file " + kind.example + ".json",
       "tribodyn " + kind.word + " export --all"},
      {},
      {},
      {}};
  command.flags.group("Arguments");
  command.flags
      .texts("name", "NAME", "Names of " + kind.plural + "; NAME@REVISION is an older revision.",
             [flags](const std::string& name) { flags->names.push_back(name); })
      .collection = kind.collection;
  command.flags.group("Options");
  command.flags.toggle("--all", "Export all, and deleted ones from which others are derived.",
                       [flags] { flags->all = true; });
  command.flags.text("--file,-f", "FILE", "Write to this file. Default: standard output.",
                     [flags](const std::string& path) { flags->file = path; });
  if (kind.word == "gear-sets") {
    command.flags.text("--tooth-contact", "FILE.csv",
                       "Write the tooth contact data as the table that import reads.",
                       [flags](const std::string& path) { flags->tooth_contact = path; });
    command.flags.text("--series", "FILE.csv",
                       "Write the Fourier series as the table that import reads.",
                       [flags](const std::string& path) { flags->series = path; });
  } else if (kind.word == "lubricants") {
    command.about +=
        " With --output csv it writes one row each: measured and stated values with their origin. "
        "Cells of computed values are empty; an import computes them again.";
    command.flags.text("--viscosity-table", "FILE.csv",
                       "Write the measured viscosities and densities as the table that import "
                       "reads.",
                       [flags](const std::string& path) { flags->viscosity_table = path; });
  } else {
    command.about += " With --output csv it writes one row each.";
  }
  command.check = [flags, &kind](Complaints& complaints) {
    if (flags->names.empty() != flags->all) {
      complaints.emplace_back(flags->all ? "give either NAME or --all"
                                         : "NAME is missing; --all exports all " + kind.plural);
    }
    const bool has_table =
        !flags->tooth_contact.empty() || !flags->series.empty() || !flags->viscosity_table.empty();
    if (has_table && flags->names.size() != 1) {
      complaints.emplace_back("tables contain one " + kind.singular + ": give one NAME");
    }
  };
  command.run = [&kind, flags](const CommonOptions& options) {
    return run_export(kind, *flags, options);
  };
  return command;
}

}  // namespace tribodyn::client
