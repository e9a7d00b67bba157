#include <iostream>
#include <memory>

#include "client/cpp/commands/command.h"
#include "client/cpp/commands/label_filter.h"
#include "client/cpp/commands/resource_writes.h"
#include "client/cpp/report/resource_report.h"
#include "client/cpp/text/text.h"

namespace tribodyn::client {
namespace {

struct ListFlags {
  ListOptions options;
  int limit = 100;
  std::vector<std::string> labels;
};

struct NameFlags {
  std::vector<std::string> names;
  std::string etag;
  int limit = 100;
};

int run_list(const ResourceKind& kind, const ListFlags& flags, const CommonOptions& options) {
  ListOptions list_options = flags.options;
  list_options.filter = with_labels(list_options.filter, flags.labels);
  list_options.limit = flags.limit;
  list_options.basic = options.output_format == OutputFormat::kTable;
  Connection connection = options.connect();
  const ResourceList list = kind.calls->list(connection, list_options);
  std::cout << resources_text(kind, list.resources, options.output_format, false);
  if (!list.next_page_token.empty()) {
    std::cerr << "These are " << list.resources.size() << " of "
              << (list.total_size < 0 ? "more" : std::to_string(list.total_size))
              << ". Use --limit N (0 lists all), or for the next page\n--page-token "
              << list.next_page_token << "\n";
  }
  return kExitOk;
}

Command list_command(const ResourceKind& kind) {
  const auto flags = std::make_shared<ListFlags>();
  Command command{kind.word + " list",
                  "list the " + kind.plural + " of the server",
                  "Lists " + kind.plural + " in the order of their names.",
                  {"tribodyn " + kind.word + " list",
                   "tribodyn " + kind.word + " list --filter name:1 --order-by name --output csv"},
                  {},
                  {},
                  {}};
  command.flags.text("--filter", "FILTER",
                     "Restrictions joined by AND, e.g. 'labels.project = \"axle\" AND "
                     "revision > 1'; `tribodyn help filters` explains them.",
                     [flags](const std::string& text) { flags->options.filter = text; });
  command.flags.texts("--label", "KEY[=VALUE]", "List only resources with this label; repeatable.",
                      [flags](const std::string& text) { flags->labels.push_back(text); });
  command.flags.text("--order-by", "FIELD",
                     "Order of the list: a field of the filter, e.g. name or 'name desc'.",
                     [flags](const std::string& text) { flags->options.order_by = text; });
  command.flags.whole_number("--limit,-n", {kind.plural, "0 to 1000000", "100"},
                             "Maximum number listed; 0 = all",
                             [flags](int value) { flags->limit = value; });
  command.flags.text(
      "--page-token", "TOKEN",
      "Read the next page; the previous page, with the same filter and order, printed the token.",
      [flags](const std::string& text) { flags->options.page_token = text; });
  command.flags.toggle("--show-deleted", "List deleted resources too.",
                       [flags] { flags->options.show_deleted = true; });
  command.check = [flags](Complaints& complaints) {
    if (flags->limit < 0 || flags->limit > 1000000) {
      complaints.emplace_back("--limit must be 0 to 1000000");
    }
  };
  command.run = [&kind, flags](const CommonOptions& options) {
    return run_list(kind, *flags, options);
  };
  return command;
}

/// Returns a command on resources that exist.
Command name_command(const ResourceKind& kind, const char* verb, const std::string& summary,
                     const std::string& about, const std::shared_ptr<NameFlags>& flags,
                     bool several) {
  Command command{kind.word + " " + verb,
                  summary,
                  about,
                  {"tribodyn " + kind.word + " " + verb + " " + kind.example},
                  {},
                  {},
                  {}};
  command.flags.group("Arguments");
  const std::string description = "The " + kind.singular + ", e.g. " + kind.example + " or " +
                                  kind.collection + "/" + kind.example + ".";
  const auto add = [flags](const std::string& name) { flags->names.push_back(name); };
  Flag& name = several ? command.flags.texts("name", "NAME", description, add)
                       : command.flags.text("name", "NAME", description, add);
  name.collection = kind.collection;
  command.check = [flags, word = kind.word](Complaints& complaints) {
    if (flags->names.empty()) {
      complaints.emplace_back("NAME is missing; `tribodyn " + word + " list` lists the names");
    }
  };
  return command;
}

Command get_command(const ResourceKind& kind) {
  const auto flags = std::make_shared<NameFlags>();
  Command command = name_command(
      kind, "get", "one " + kind.singular + " with the origin of each parameter",
      "Prints one " + kind.singular +
          ": every parameter, its value, its uncertainty and origin. NAME@REVISION is an "
          "older revision.",
      flags, false);
  command.run = [&kind, flags](const CommonOptions& options) {
    Connection connection = options.connect();
    const auto resource = kind.calls->get(connection, kind.name_of(flags->names.front()));
    std::cout << resource_text(*resource, options.output_format);
    return kExitOk;
  };
  return command;
}

Command revisions_command(const ResourceKind& kind) {
  const auto flags = std::make_shared<NameFlags>();
  Command command = name_command(kind, "revisions", "list the revisions of one " + kind.singular,
                                 "Lists the revisions of a " + kind.singular +
                                     ", newest first. A revision never changes; results keep "
                                     "theirs.",
                                 flags, false);
  command.flags.group("Options");
  command.flags.whole_number("--limit,-n", {"revisions", "0 to 1000000", "100"},
                             "Maximum number listed; 0 = all",
                             [flags](int value) { flags->limit = value; });
  command.run = [&kind, flags](const CommonOptions& options) {
    Connection connection = options.connect();
    const ResourceList list =
        kind.calls->revisions(connection, kind.name_of(flags->names.front()), flags->limit);
    std::cout << resources_text(kind, list.resources, options.output_format, true);
    if (!list.next_page_token.empty()) std::cerr << "Older revisions exist; --limit 0 lists all.\n";
    return kExitOk;
  };
  return command;
}

/// Returns delete or undelete, which print one line per resource.
Command deletion_command(const ResourceKind& kind, bool undelete) {
  const auto flags = std::make_shared<NameFlags>();
  Command command = name_command(
      kind, undelete ? "undelete" : "delete",
      undelete ? "restore deleted " + kind.plural
               : "delete " + kind.plural + "; undelete restores them",
      undelete
          ? "Restores deleted " + kind.plural + "."
          : "Removes " + kind.plural +
                " from lists and from new simulations. Results keep their revisions, and undelete "
                "restores them.",
      flags, true);
  command.flags.group("Options");
  command.flags.text("--etag", "ETAG", "Fail if the resource has changed since it had this etag.",
                     [flags](const std::string& text) { flags->etag = text; });
  command.run = [&kind, flags, undelete](const CommonOptions& options) {
    Connection connection = options.connect();
    std::vector<ResourcePointer> resources;
    for (const std::string& name : flags->names) {
      resources.push_back(undelete
                              ? kind.calls->undelete(connection, kind.name_of(name), flags->etag)
                              : kind.calls->remove(connection, kind.name_of(name), flags->etag));
      if (options.output_format == OutputFormat::kTable) {
        std::cout << (undelete ? "undeleted " : "deleted ")
                  << printable(text_field(*resources.back(), "name")) << "\n";
      }
    }
    if (options.output_format != OutputFormat::kTable) {
      std::cout << resources_text(kind, resources, options.output_format, false);
    }
    return kExitOk;
  };
  return command;
}

std::string counted(int number, const char* singular, const char* plural) {
  return std::to_string(number) + " " + (number == 1 ? singular : plural);
}

Command purge_command(const ResourceKind& kind) {
  const auto flags = std::make_shared<NameFlags>();
  const auto purge = std::make_shared<PurgeOptions>();
  Command command = name_command(
      kind, "purge", "erase " + kind.plural + " for good",
      "Erases " + kind.plural +
          " with all revisions: their numbers and texts are then in no file of the server's "
          "database. Nothing restores them. Refused while jobs used one of them, unless "
          "--with-jobs is set.",
      flags, true);
  command.flags.group("Options");
  command.flags.toggle("--with-jobs",
                       "Delete every job that used them too, pinned or not, with its results.",
                       [purge] { purge->delete_simulations = true; });
  command.flags.toggle("--validate-only", "Print what would be erased; erase nothing.",
                       [purge] { purge->validate_only = true; });
  command.flags.toggle("--allow-missing", "Skip names that do not exist.",
                       [purge] { purge->allow_missing = true; });
  command.flags.text("--etag", "ETAG", "Fail if the resource has changed since it had this etag.",
                     [purge](const std::string& text) { purge->etag = text; });
  command.run = [&kind, flags, purge](const CommonOptions& options) {
    Connection connection = options.connect();
    std::vector<std::string> remaining;
    bool copies_remain = false;
    for (const std::string& name : flags->names) {
      const v1::PurgeReport report = kind.calls->purge(connection, kind.name_of(name), *purge);
      std::cout << (purge->validate_only ? "would erase " : "erased ") << printable(report.name())
                << ": " << counted(report.revisions(), "revision", "revisions") << ", "
                << counted(report.simulations(), "job", "jobs") << ", "
                << counted(report.results(), "result", "results") << "\n";
      remaining.assign(report.remaining_files().begin(), report.remaining_files().end());
      copies_remain = copies_remain || report.copies_remain();
    }
    if (copies_remain) {
      std::cerr << "Copies of the whole database beside it may still hold what was erased; a purge "
                   "by an administrator of all projects names or removes them\n";
    }
    for (const std::string& file : remaining) {
      std::cerr << "A restore kept the former database beside the present one; it may still hold "
                   "what was erased: "
                << printable(file) << "\n";
    }
    return kExitOk;
  };
  return command;
}

}  // namespace

std::vector<Command> resource_commands(const ResourceKind& kind) {
  std::vector<Command> commands;
  commands.push_back(list_command(kind));
  commands.push_back(get_command(kind));
  commands.push_back(create_command(kind));
  commands.push_back(update_command(kind));
  commands.push_back(deletion_command(kind, false));
  commands.push_back(deletion_command(kind, true));
  commands.push_back(purge_command(kind));
  commands.push_back(revisions_command(kind));
  commands.push_back(import_command(kind));
  commands.back().main_flags = {"--id",      "--like",      "--replace",       "--validate-only",
                                "--profile", "--series",    "--tooth-contact", "--viscosity-table",
                                "--label",   "--density15", "--base-oil-class"};
  commands.push_back(export_command(kind));
  return commands;
}

}  // namespace tribodyn::client
