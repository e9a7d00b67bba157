#pragma once

#include <string>
#include <vector>

#include "client/cpp/resources/kind.h"
#include "client/cpp/text/output.h"

namespace tribodyn::client {

/// What a text about a lubricant holds: all, or in place of the parameters their number by origin
/// and the command that lists them. Texts about other resources hold all.
enum class ResourceDetail { kAll, kSummary };

/// Returns one resource as text: its names, for a lubricant its viscosities, index, grade and the
/// misfit of its laws, every parameter with unit, uncertainty and origin, and the warnings.
std::string resource_sheet(const google::protobuf::Message& resource,
                           ResourceDetail detail = ResourceDetail::kAll);

/// Returns a table with one line per resource. `as_revisions`: revisions of one resource, newest
/// first.
std::string resource_table(const ResourceKind& kind, const std::vector<ResourcePointer>& resources,
                           bool as_revisions);

/// Returns one resource in any format. Only a table depends on `detail`.
std::string resource_text(const google::protobuf::Message& resource, OutputFormat format,
                          ResourceDetail detail = ResourceDetail::kAll);
/// Returns resources as a table, as CSV with every number, or as JSON like the server's list
/// response.
std::string resources_text(const ResourceKind& kind, const std::vector<ResourcePointer>& resources,
                           OutputFormat format, bool as_revisions);

/// Returns JSON that import reads: one resource, or an object with a list. Omits fields that only
/// the server sets.
std::string export_text(const ResourceKind& kind, const std::vector<ResourcePointer>& resources);

/// Returns the provenance of one parameter; null if the resource states none.
const v1::ParameterProvenance* provenance_of(const google::protobuf::Message& resource,
                                             const std::string& field);

/// Returns figures, warnings and fits of a lubricant's characterisation.
std::string characterisation_sheet(const v1::Lubricant& lubricant);
/// Returns only the warnings, at least one line each; empty if there are none.
std::string characterisation_warnings(const v1::Lubricant& lubricant);

}  // namespace tribodyn::client
