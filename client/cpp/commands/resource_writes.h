#pragma once

#include <memory>
#include <string>
#include <vector>

#include "client/cpp/commands/command.h"
#include "client/cpp/report/resource_report.h"
#include "client/cpp/resources/edits.h"
#include "client/cpp/resources/kind.h"

namespace tribodyn::client {

Command create_command(const ResourceKind& kind);
Command update_command(const ResourceKind& kind);
Command import_command(const ResourceKind& kind);
Command export_command(const ResourceKind& kind);

/// The paths of tables from which the server makes a resource.
struct TableFiles {
  std::string viscosity_table;  ///< for a lubricant
  std::string tooth_contact;    ///< for a gear set
  std::string series;           ///< for a gear set; may be empty
  /// For a surface.
  struct Profile {
    v1::FlankMember member = v1::FLANK_MEMBER_UNSPECIFIED;
    v1::ProfileDirection direction = v1::PROFILE_DIRECTION_UNSPECIFIED;
    std::string path;
  };
  std::vector<Profile> profiles;
  v1::Levelling levelling = v1::LEVELLING_UNSPECIFIED;
  double short_wave_cut_off_metres = 0;  ///< lambda_s; 0: no filter
  double long_wave_cut_off_metres = 0;   ///< lambda_c; 0: no filter
  bool eq46_as_published = false;

  bool empty() const {
    return viscosity_table.empty() && tooth_contact.empty() && profiles.empty();
  }
};

/// Reads "pinion,axial,FILE"; member and direction may be missing. Returns false if the text is
/// something else.
bool read_profile(const std::string& text, TableFiles::Profile& profile);
/// Reads the file of a profile. Throws Failure.
v1::SurfaceProfile profile_message(const TableFiles::Profile& profile);
/// Adds the flag or argument `name` for profiles, and the flags of their treatment before their
/// moments are formed. They write to `tables`, which must outlive them.
void add_profile_flags(FlagList& flags, const char* name, TableFiles& tables);
/// Returns the error with the user's file names in place of the request's fields.
ServiceError with_file_names(const ServiceError& error, const TableFiles& tables);

/// Adds the flags that name tables of this kind; vehicles have none. They write to `tables`, which
/// must outlive them.
void add_table_flags(FlagList& flags, const ResourceKind& kind, TableFiles& tables);
/// Adds a file that was named without a flag: the table of its kind.
void add_table(const ResourceKind& kind, const std::string& path, TableFiles& tables);

/// Returns a copy of a resource without its name, fields that the server sets and fields that the
/// tables contain. Omits title and description, which may not apply to the copy. The source of a
/// parameter becomes "as in surfaces/run-in@1", where the original source is.
ResourcePointer copy_of(Connection& connection, const ResourceKind& kind, const std::string& name,
                        const TableFiles& tables);

/// Returns the resource from which rows of a table start: a copy of the resource of --like, without
/// texts that describe only that resource.
ResourcePointer base_of_rows(Connection& connection, const ResourceKind& kind,
                             const std::string& like);

/// Creates a resource from `resource` and the tables, if there are any.
ResourcePointer create_with_tables(Connection& connection, const ResourceKind& kind,
                                   const google::protobuf::Message& resource, const std::string& id,
                                   const TableFiles& tables, bool validate_only);

/// Prints `done` with the name of a resource, then the resource, on standard output. All of it if
/// `validate_only`, because a resource that was not written cannot be shown afterwards.
void show_written(const char* done, const google::protobuf::Message& resource, bool validate_only,
                  OutputFormat format, ResourceDetail detail);

}  // namespace tribodyn::client
