#pragma once

#include <memory>
#include <string>
#include <vector>

#include "client/cpp/commands/command.h"
#include "client/cpp/resources/edits.h"
#include "client/cpp/resources/kind.h"

namespace tribodyn::client {

Command create_command(const ResourceKind& kind);
Command update_command(const ResourceKind& kind);
Command import_command(const ResourceKind& kind);
Command export_command(const ResourceKind& kind);

/// Tables that the server turns into a resource, each as the path of its file.
struct TableFiles {
  std::string viscosity_table;  ///< of a lubricant
  std::string tooth_contact;    ///< of a gear set
  std::string series;           ///< of a gear set; may be empty
  /// Of a surface.
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

/// The flags that name tables of this kind; vehicles have none. They write to `tables`, which must
/// outlive them.
void add_table_flags(FlagList& flags, const ResourceKind& kind, TableFiles& tables);
/// A file named without a flag: the table of its kind.
void add_table(const ResourceKind& kind, const std::string& path, TableFiles& tables);

/// A copy of a resource that exists, without its name and what the server sets; without what the
/// tables bring, too. Title and description are not copied, as they may be untrue of the copy; the
/// source of a parameter becomes "as in surfaces/run-in@1", where the words of the original stand.
ResourcePointer copy_of(Connection& connection, const ResourceKind& kind, const std::string& name,
                        const TableFiles& tables);

/// Creates a resource from what is known of it and its tables; without tables, from that alone.
ResourcePointer create_with_tables(Connection& connection, const ResourceKind& kind,
                                   const google::protobuf::Message& resource, const std::string& id,
                                   const TableFiles& tables, bool validate_only);

/// Says on standard output what was done to a resource, then shows it.
void show_written(const char* done, const google::protobuf::Message& resource, bool validate_only,
                  OutputFormat format);

}  // namespace tribodyn::client
